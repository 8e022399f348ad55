// Checks of values in the text: comparisons, joined texts, formats and arguments that cannot be right because of what
// the names stand for, in whatever branch they are.
#pragma once

#include <string>
#include <vector>

#include "check_arguments.h"
#include "known_names.h"
#include "signal/status_fields.h"
#include "source_scopes.h"

namespace kadans {

class ValueCheck {
 public:
  explicit ValueCheck(const Behavior::Parts& parts);

  // What is wrong with what stands around one use of a name.
  Mistakes of_use(const SourceUse& use, const Tokens& tokens) const;
  // What is wrong with values that are written out: "a" + 1, x .. nil.
  Mistakes of_literals(const Tokens& tokens) const;

 private:
  // What a name stands for; `texts` are all that a choice may be.
  enum class Kind : std::uint8_t { unknown, number, flag, choice, by_name };
  struct Type {
    Kind kind = Kind::unknown;
    std::vector<std::string> texts;
    bool measured = false;  // a number that comes from a sensor
  };
  Type type_of(const SourceMeaning& meaning) const;
  Type field_of(StatusField::Part part, const std::string& name, std::size_t index = 0) const;
  std::string compared(const SourceUse& use, const Type& type, const Tokens& tokens, std::size_t value,
                       const SourceToken& sign) const;
  void operands(const SourceUse& use, const Type& type, const Tokens& tokens, Mistakes& found) const;
  std::string other_unit(const SourceUse& use, const Tokens& tokens) const;
  std::string call(const SourceUse& use, const Tokens& tokens) const;
  std::string machine_call(const SourceUse& use, const Tokens& tokens) const;
  std::string armed(const SourceUse& use, const Tokens& tokens) const;
  std::string condition(const std::string& text) const;

  const Behavior::Parts& parts_;
  std::vector<StatusField> fields_;
};

// Compares the formats of string.format and k.log with the values behind them, as far as they are written out. `at` is
// the first token in the brackets of the call. "" when nothing is wrong.
std::string format_mistake(const Tokens& tokens, std::size_t at, const std::string& called);
// print("x %d", 1)
std::string print_mistake(const Tokens& tokens, std::size_t at);

}  // namespace kadans
