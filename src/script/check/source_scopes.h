// Finds the meaning of the names in a script by reading it: blocks and locals, functions and their arguments, and facts
// about the functions, tables and modules of all files of a behavior.
#pragma once

#include <compare>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "source_lexer.h"

namespace kadans {

// Facts about a behavior's functions, tables and modules, collected from all its files: which function a field holds,
// what a module returns, which arguments a function gets.
//
// A name has a known value only when the same value is assigned everywhere. The files are read again and again in three
// phases (SourceFacts::Phase), until nothing new is learnt.
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
  SourcePlace place{};  // where a function or table is written; for parameters: their file, and 1 for arguments
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
    std::set<std::uint16_t> states;  // the states of the chart whose function it is, or whose functions call it
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

// Finds the meaning of the names in a script by reading it: blocks and locals, functions and their arguments.
//
// A function gets `m` and `s` when it is one of the chart's functions (`enter`, `when` ...), or when such a function
// passes them on to it, in any of the files. Facts about functions, tables and modules are kept in SourceFacts, which
// the files of a behavior share.

// One use of a name: `m.posture:move(` or `x.y = `.
struct SourceUse {
  SourceMeaning meaning;    // meaning of the name and the fields after it
  std::string name;         // as written
  std::vector<int> lines;   // of the fields in meaning.path
  std::size_t written = 0;  // how many of these fields, the last ones, are written here
  bool known = false;       // a local or parameter, or `require` of a module
  bool outer = false;       // a local of a function around this one, or of the file
  bool assigned = false;    // stands left of a '='
  bool guard = false;       // in a guard or in a function that a guard calls
  std::string at_once;      // the key ("enter" ...) of a function that ends within its tick, when this use is in it
                            // or in a function that it always calls; else ""
  std::set<std::uint16_t> states;  // the states whose function it stands in, or whose functions call that one
  std::string method;              // after ':', or ""
  int line = 0;                    // of the name
  std::size_t arguments = 0;       // index of the token after the '(' of a call; 0: no call
  std::size_t at = 0;              // index of the name's token
  std::size_t declared = 0;        // index of the token that declares the name; 0: no local
  std::size_t next = 0;            // index of the token after the whole use, the '=' of an assignment
};

// A function that is written in the text.
struct SourceFunction {
  int line = 0;
  bool guard = false;          // stands under `when`, directly or by its name
  bool returns_value = false;  // it returns a value somewhere; functions inside it do not count
};

// Hears of each use of a name, in the order of the text.
using SourceListener = std::function<void(const SourceUse& use, const Tokens& tokens)>;

class SourceScopes {
 public:
  // The functions of the chart that begin in a line: their keys ("enter", "when" ...), and the states whose they are.
  struct ChartLine {
    std::set<std::string> keys;
    std::set<std::uint16_t> states;
  };
  using ChartLines = std::map<int, ChartLine>;

  // `file` is its number among the files that share `facts`. `facts` must outlive this object.
  SourceScopes(Tokens tokens, std::size_t file, SourceFacts& facts);
  // Gives the functions of the chart: only these are guards, end within their tick, or get `m` and `s`. Without this
  // call, every function counts as what its key says.
  void know_functions(ChartLines chart) { chart_ = std::move(chart); }
  // Reads the file once and adds to the facts.
  void read() { walk({}); }
  void tell(const SourceListener& listener) { walk(listener); }

  // After tell(): all functions; the first is the file itself.
  std::vector<SourceFunction> functions() const;
  const Tokens& tokens() const noexcept { return tokens_; }
  std::size_t file() const noexcept { return file_; }

 private:
  using Function = SourceFacts::Function;
  struct Block {
    std::map<std::string, std::size_t> locals;  // the tokens that declare them
    std::size_t function = 0;
    bool body = false;  // the block is the function's body, not a statement's
  };
  struct Braces {  // the braces of a table
    std::size_t token = 0;
    std::size_t blocks = 0;  // number of blocks that are open around it
  };

  void walk(const SourceListener& listener);
  std::size_t step(std::size_t at);
  void symbol_at(std::size_t at);
  void return_at(std::size_t at);
  std::size_t function_at(std::size_t at);
  SourceMeaning name_function(std::size_t start);
  void call_by_chart(std::size_t start);
  std::size_t local_at(std::size_t at);
  std::size_t for_at(std::size_t at);
  std::size_t name_at(std::size_t at);
  std::size_t key_at(std::size_t at);
  void assign(const SourceUse& use, std::size_t at);
  void hand_on(const SourceUse& call, SourcePlace callee);
  std::string at_once(std::size_t at) const;
  void give_key(const std::string& key, SourcePlace function);
  void open(std::size_t function, bool body = false);
  void close();

  // What an expression stands for.
  bool in_table() const { return !braces_.empty() && braces_.back().blocks == blocks_.size(); }
  bool is_key(std::size_t at) const;
  bool is_assigned(std::size_t at) const;
  const std::size_t* find(const std::string& name, bool& outer) const;
  std::size_t start_at(std::size_t at, SourceUse& use) const;
  std::size_t fields_at(std::size_t at, SourceUse& use) const;
  void look_through(SourceUse& use) const;
  std::optional<SourcePlace> callee_of(const SourceUse& call) const;
  std::optional<SourcePlace> tail_at(std::size_t at) const;
  bool is_motion(SourceUse call) const;
  SourceMeaning value_at(std::size_t at) const;

  Function& function(std::size_t token) { return facts_->functions[{file_, token}]; }

  Tokens tokens_;
  std::size_t file_ = 0;
  SourceFacts* facts_;
  std::optional<ChartLines> chart_;
  std::map<int, int> functions_by_line_;  // number of functions that begin on each line
  std::vector<Block> blocks_;
  std::vector<Braces> braces_;
  std::map<std::string, std::size_t> next_locals_;  // locals of the next block
  SourceListener listener_;
};

// Reads the files until no new facts are learnt.
void learn_facts(const std::vector<SourceScopes*>& files, SourceFacts& facts);

}  // namespace kadans
