// What the names in a script stand for, found by reading it: blocks and locals, functions and what they are given.
//
// A function is given `m` and `s` when it stands under a key that takes one (`enter`, `when` ...), or when such a
// function hands them on to it. Reading is repeated until nothing new is learnt; then `Listener` is told.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "source_lexer.h"

namespace kadans {

enum class SourceRole : std::uint8_t { none, machine, snapshot, module, parameters, function };

// What an expression stands for: `m.posture` is {machine, {"posture"}}.
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
  std::string method;         // after ':', or ""
  int line = 0;               // of the name
  std::size_t arguments = 0;  // token after the '(' of a call; 0: no call
};

class SourceListener {
 public:
  virtual ~SourceListener() = default;
  virtual void used(const SourceUse& use, const std::vector<SourceToken>& tokens) = 0;
};

class SourceScopes {
 public:
  explicit SourceScopes(std::vector<SourceToken> tokens);
  void tell(SourceListener& listener);

 private:
  struct Function {
    std::map<std::size_t, SourceMeaning> given;  // by the number of the parameter
    bool guard = false;
  };
  struct Block {
    std::map<std::string, SourceMeaning> locals;
    std::size_t function = 0;
  };

  void walk(SourceListener* listener);
  std::size_t step(std::size_t at);
  std::size_t function_at(std::size_t at);
  std::size_t local_at(std::size_t at);
  std::size_t for_at(std::size_t at);
  std::size_t name_at(std::size_t at);
  std::size_t fields_at(std::size_t at, SourceUse& use) const;
  void hand_on(std::size_t arguments, const SourceMeaning& callee, bool guard);
  void give_key(const std::string& key, std::size_t function);
  void give(std::size_t function, std::size_t parameter, const SourceMeaning& meaning);
  void open(std::size_t function);
  void close();
  bool is_key(std::size_t at) const;
  const SourceMeaning* find(const std::string& name, bool& outer) const;
  SourceMeaning value_at(std::size_t at) const;

  std::vector<SourceToken> tokens_;
  std::map<std::size_t, Function> functions_;  // by the token `function`
  std::vector<Block> blocks_;
  std::map<std::string, SourceMeaning> next_locals_;  // of the block that comes
  SourceListener* listener_ = nullptr;
  bool learnt_ = false;
};

}  // namespace kadans
