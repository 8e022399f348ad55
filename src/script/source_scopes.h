// What the names in a script stand for, found by reading it: blocks and locals, functions and what they are given.
//
// A function is given `m` and `s` when it stands under a key that takes one (`enter`, `when` ...), or when such a
// function hands them on to it. Reading is repeated until nothing new is learnt; then `Listener` is told.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "source_lexer.h"

namespace kadans {

enum class SourceRole : std::uint8_t { none, machine, snapshot, module, own_module, parameters, motion, function };

// What an expression stands for: `m.posture` is {machine, {"posture"}}, `legs.bend` of the author's module "legs"
// {own_module, {"legs", "bend"}}.
struct SourceMeaning {
  SourceRole role = SourceRole::none;
  std::vector<std::string> path{};
  std::size_t function = 0;
};

// One use of a name: `m.posture:move(` or `x.y = `.
struct SourceUse {
  SourceMeaning meaning;      // of the name and the fields after it
  std::string name;           // as written
  std::vector<int> lines;     // of the fields in meaning.path
  std::size_t written = 0;    // how many of them stand here, the last ones
  bool known = false;         // a local or parameter
  bool outer = false;         // a local of a function around this one, or of the file
  bool assigned = false;      // stands left of a '='
  bool guard = false;         // in a guard or in what a guard calls
  std::string at_once;        // "enter" or another key whose function is over within its tick, if it is in one or in
                              // what one calls, and runs whenever that does; or ""
  std::string method;         // after ':', or ""
  int line = 0;               // of the name
  std::size_t arguments = 0;  // token after the '(' of a call; 0: no call
  std::size_t next = 0;       // token behind all of it, the '=' of an assignment
};

// A function that is written out.
struct SourceFunction {
  int line = 0;
  bool guard = false;          // stands under `when`, itself or by its name
  bool returns_value = false;  // somewhere; not one that is written inside it
};

class SourceListener {
 public:
  virtual ~SourceListener() = default;
  virtual void used(const SourceUse& use, const std::vector<SourceToken>& tokens) = 0;
};

class SourceScopes {
 public:
  explicit SourceScopes(std::vector<SourceToken> tokens);
  // Where the functions of the chart begin: only those are guards, or over within their tick, for sure. Without it
  // every function is whose key says so.
  void know_functions(std::set<int> lines) { chart_lines_ = std::move(lines); }
  void tell(SourceListener& listener);

  // After tell(): all functions, the file itself first.
  std::vector<SourceFunction> functions() const;
  const std::vector<SourceToken>& tokens() const noexcept { return tokens_; }

 private:
  struct Function {
    std::map<std::size_t, SourceMeaning> given;  // by the number of the parameter
    bool guard = false;                          // or called by one
    bool under_when = false;
    bool returns_value = false;
    int returns = 0;       // that stand before what is read, or right before it
    bool literal = false;  // of `at_once`: stands under the key itself
    std::string at_once;
  };
  struct Block {
    std::map<std::string, SourceMeaning> locals;
    std::size_t function = 0;
    bool body = false;  // of the function, not of a statement in it
  };

  void walk(SourceListener* listener);
  std::size_t step(std::size_t at);
  std::size_t function_at(std::size_t at);
  std::size_t local_at(std::size_t at);
  std::size_t for_at(std::size_t at);
  std::size_t name_at(std::size_t at);
  std::size_t fields_at(std::size_t at, SourceUse& use) const;
  void hand_on(const SourceUse& call);
  std::string at_once(std::size_t at) const;
  bool is_motion(const SourceUse& call) const;
  void give_key(const std::string& key, std::size_t function);
  void give(std::size_t function, std::size_t parameter, const SourceMeaning& meaning);
  void open(std::size_t function, bool body = false);
  void close();
  bool is_key(std::size_t at) const;
  const SourceMeaning* find(const std::string& name, bool& outer) const;
  SourceMeaning value_at(std::size_t at) const;

  std::vector<SourceToken> tokens_;
  std::optional<std::set<int>> chart_lines_;
  std::map<std::size_t, Function> functions_;  // by the token `function`
  std::vector<Block> blocks_;
  std::map<std::string, SourceMeaning> next_locals_;  // of the block that comes
  SourceListener* listener_ = nullptr;
  bool learnt_ = false;
};

}  // namespace kadans
