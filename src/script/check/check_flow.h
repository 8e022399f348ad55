// Finds what cannot be meant in how a script goes on: loops that never end, motions that are replaced before they
// begin, keys that stand twice in a table, and values that a reload loses.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "check_arguments.h"
#include "known_names.h"
#include "source_scopes.h"

namespace kadans {

class FlowCheck {
 public:
  // `of_behavior`: the file is a behavior's own, no module.
  FlowCheck(const Catalog& catalog, const KnownNames& known, bool of_behavior)
      : catalog_(catalog), known_(known), of_behavior_(of_behavior) {}

  // First all uses of names in the file, then what is wrong.
  void note(const SourceUse& use) {
    if (use.assigned) assigned_.insert(use.declared);
    uses_.emplace(use.at, use);
  }
  Mistakes run(const Tokens& tokens);

 private:
  enum class Call { harmless, waits, unknown };
  struct Body {
    bool waits = false, unknown = false, leaves = false;
  };
  struct Loop {
    std::size_t condition = 0, condition_end = 0, body = 0, body_end = 0;
    bool until = false;
    std::set<std::size_t> assigned;  // the names that get a value in the body, by the tokens that declare them
    bool assigns_field = false;
  };
  struct Block {
    std::size_t token = 0;
    bool returns = false;             // there was a `return` in it or in a block inside it
    std::map<std::string, int> keys;  // of a table: their lines
  };

  void tell(int line, std::string text) { found_.push_back({line, std::move(text)}); }
  const SourceUse* use_at(std::size_t at) const;
  Call kind_of(const SourceUse& use, const Tokens& tokens) const;
  Body body_of(const Tokens& tokens, std::size_t from, std::size_t to) const;
  void note_assigned(Loop& loop) const;
  bool stays(const SourceUse& use, const Loop& loop) const;
  bool never_changes(const Tokens& tokens, const Loop& loop) const;
  const SourceUse* stale(const Tokens& tokens, const Loop& loop) const;
  bool only_waits(const Tokens& tokens, const Loop& loop) const;
  void loop(const Tokens& tokens, std::size_t head);

  bool is_move(const SourceUse& use) const;
  std::optional<std::set<std::string>> joints_of(const Tokens& tokens, std::size_t pose, bool numbers_only) const;
  double time_of(const Tokens& tokens, std::size_t options) const;
  const SourceUse* next_statement(const Tokens& tokens, std::size_t at) const;
  void replaced(const SourceUse& use, const Tokens& tokens);
  void begun_anew(const SourceUse& use, const Tokens& tokens);

  void enter_token(const Tokens& tokens, std::size_t at);
  void key(const Tokens& tokens, std::size_t at);
  void local_of_file(const SourceUse& use, const Tokens& tokens);

  const Catalog& catalog_;
  const KnownNames& known_;
  bool of_behavior_;
  std::map<std::size_t, SourceUse> uses_;
  std::set<std::size_t> assigned_;  // the names that get a value anywhere but where they are declared
  std::vector<Block> blocks_;
  std::set<std::size_t> locals_of_file_;  // the tokens that declare them with a plain value
  Mistakes found_;
};

}  // namespace kadans
