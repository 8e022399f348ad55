// What the names in a script stand for, found by reading it: blocks and locals, functions and what they are given.
//
// A function is given `m` and `s` when it is one of the chart's (`enter`, `when` ...), or when such a function hands
// them on to it, whichever of the files it is in. What is learnt of functions, tables and modules stands in
// SourceFacts, which the files of a behavior share.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "source_facts.h"
#include "source_lexer.h"

namespace kadans {

// One use of a name: `m.posture:move(` or `x.y = `.
struct SourceUse {
  SourceMeaning meaning;      // of the name and the fields after it
  std::string name;           // as written
  std::vector<int> lines;     // of the fields in meaning.path
  std::size_t written = 0;    // how many of them stand here, the last ones
  bool known = false;         // a local or parameter, or `require` of a module
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
  // The keys of the chart's functions ("enter", "when" ...) by the line where they begin.
  using ChartFunctions = std::map<int, std::set<std::string>>;

  // `file`: its number among those that share the facts, which outlive this.
  SourceScopes(std::vector<SourceToken> tokens, std::size_t file, SourceFacts& facts);
  // Only the chart's functions are guards, or over within their tick, or given `m` and `s`. Without them every function
  // is whose key says so.
  void know_functions(ChartFunctions chart) { chart_ = std::move(chart); }
  // Reads the file once, which adds to the facts.
  void read() { walk(nullptr); }
  void tell(SourceListener& listener) { walk(&listener); }

  // After tell(): all functions, the file itself first.
  std::vector<SourceFunction> functions() const;
  const std::vector<SourceToken>& tokens() const noexcept { return tokens_; }
  std::size_t file() const noexcept { return file_; }

 private:
  using Function = SourceFacts::Function;
  struct Block {
    std::map<std::string, std::size_t> locals;  // the tokens that declare them
    std::size_t function = 0;
    bool body = false;  // of the function, not of a statement in it
  };
  struct Braces {  // of a table
    std::size_t token = 0;
    std::size_t blocks = 0;  // that are open around it
  };

  void walk(SourceListener* listener);
  std::size_t step(std::size_t at);
  void symbol_at(std::size_t at);
  void return_at(std::size_t at);
  std::size_t function_at(std::size_t at);
  SourceMeaning name_function(std::size_t start);
  void call_by_chart(std::size_t function);
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

  // source_values.cpp: what an expression stands for.
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

  std::vector<SourceToken> tokens_;
  std::size_t file_ = 0;
  SourceFacts* facts_;
  std::optional<ChartFunctions> chart_;
  std::map<int, int> functions_by_line_;  // how many begin there
  std::vector<Block> blocks_;
  std::vector<Braces> braces_;
  std::map<std::string, std::size_t> next_locals_;  // of the block that comes
  SourceListener* listener_ = nullptr;
};

// Reads the files until nothing new is learnt of what they share.
void learn_facts(const std::vector<SourceScopes*>& files, SourceFacts& facts);

}  // namespace kadans
