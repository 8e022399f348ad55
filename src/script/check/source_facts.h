// Facts about a behavior's functions, tables and modules, collected from all its files: which function a field holds,
// what a module returns, which arguments a function gets.
//
// A name has a known value only when the same value is assigned everywhere. The files are read again and again in three
// phases (SourceFacts::Phase), until nothing new is learnt.
#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace kadans {

enum class SourceRole : std::uint8_t {
  none,
  machine,
  snapshot,
  module,
  own_module,
  parameters,
  motion,
  function,
  table
};

// The place of a token: its file and its index there.
struct SourcePlace {
  std::size_t file = 0, token = 0;
  auto operator<=>(const SourcePlace&) const = default;
};

// The meaning of an expression. `m.posture` is {machine, {"posture"}}; `legs.bend` of the author's module "legs" is
// {own_module, {"legs", "bend"}}; field `w` of a table that is written at `place` is {table, {"w"}, place}.
struct SourceMeaning {
  SourceRole role = SourceRole::none;
  std::vector<std::string> path{};
  SourcePlace place{};  // where a function or table is written; for parameters: their file
  bool operator==(const SourceMeaning&) const = default;
};

class SourceFacts {
 public:
  enum class Phase : std::uint8_t {
    values,   // find values of names; a value that is unknown now may be known after the next reading
    unknown,  // unknown values stay unknown: names to which one is assigned have no value
    calls     // names are final: find which functions run in guards, and which end within their tick
  };
  struct Function {
    int line = 0;
    bool in_chart = false;                       // may be a function of the chart
    std::map<std::size_t, SourceMeaning> given;  // values by the number of the argument; 0 is `self` of a method
    bool guard = false;                          // it is a guard, or a guard calls it
    bool under_when = false;
    bool returns_value = false;   // it has a `return` with a value
    std::set<SourcePlace> tails;  // the functions whose values it returns: `return f(x)`
    int returns = 0;              // number of `return`s up to the current place
    bool literal = false;         // it is written directly under the key of `at_once`
    std::string at_once;
  };

  void name_module(const std::string& name, std::size_t file) { modules_[name] = file; }

  // These functions note an assigned value. A value of role `none` is unknown.
  void give_local(SourcePlace name, const SourceMeaning& value) { learn(locals_, name, value); }
  void give_field(const SourceMeaning& table, const std::string& field, const SourceMeaning& value);
  void give_parameter(SourcePlace function, std::size_t number, const SourceMeaning& value);
  void give_module(std::size_t file, const SourceMeaning& returned) { learn(returned_, file, returned); }
  // A field of an unknown table.
  void give_somewhere(const std::string& field) { given_somewhere_.insert(field); }

  SourceMeaning local(SourcePlace name) const;
  // Follows a meaning through tables and modules as far as they are known. `written` is the number of the path's last
  // fields that are written at the place of use; it is updated.
  SourceMeaning resolve(const SourceMeaning& meaning, std::size_t& written) const;
  SourceMeaning resolve(const SourceMeaning& meaning) const;
  // True unless it is known that the function returns no value.
  bool returns_value(SourcePlace function) const;
  // The fields that any file assigns to an author's module.
  std::vector<std::string> fields_of(const std::string& module) const;
  const std::set<std::string>& given_somewhere() const noexcept { return given_somewhere_; }

  std::map<SourcePlace, Function> functions;  // by their token `function`; a file counts as one, by its first token
  Phase phase = Phase::values;
  bool learnt = false;  // something was learnt since it was set to false

 private:
  template <typename Values, typename Key>
  void learn(Values& values, const Key& key, const SourceMeaning& value);
  bool returns_value(SourcePlace function, int depth, std::set<SourcePlace>& without) const;
  std::optional<SourceMeaning> follow(const SourceMeaning& meaning) const;
  std::optional<SourcePlace> table(SourceMeaning meaning) const;

  std::map<SourcePlace, SourceMeaning> locals_;  // by the token that declares them
  std::map<SourcePlace, std::map<std::string, SourceMeaning>> tables_;
  std::map<std::size_t, SourceMeaning> returned_;  // by files
  std::map<std::string, std::size_t> modules_;
  std::set<std::string> given_somewhere_;
};

}  // namespace kadans
