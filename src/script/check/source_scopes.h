// Finds the meaning of the names in a script by reading it: blocks and locals, functions and their arguments.
//
// A function gets `m` and `s` when it is one of the chart's functions (`enter`, `when` ...), or when such a function
// passes them on to it, in any of the files. Facts about functions, tables and modules are kept in SourceFacts, which
// the files of a behavior share.
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
  SourceMeaning meaning;      // meaning of the name and the fields after it
  std::string name;           // as written
  std::vector<int> lines;     // of the fields in meaning.path
  std::size_t written = 0;    // how many of these fields, the last ones, are written here
  bool known = false;         // a local or parameter, or `require` of a module
  bool outer = false;         // a local of a function around this one, or of the file
  bool assigned = false;      // stands left of a '='
  bool guard = false;         // in a guard or in a function that a guard calls
  std::string at_once;        // the key ("enter" ...) of a function that ends within its tick, when this use is in it
                              // or in a function that it always calls; else ""
  std::string method;         // after ':', or ""
  int line = 0;               // of the name
  std::size_t arguments = 0;  // index of the token after the '(' of a call; 0: no call
  std::size_t next = 0;       // index of the token after the whole use, the '=' of an assignment
};

// A function that is written in the text.
struct SourceFunction {
  int line = 0;
  bool guard = false;          // stands under `when`, directly or by its name
  bool returns_value = false;  // it returns a value somewhere; functions inside it do not count
};

class SourceListener {
 public:
  virtual ~SourceListener() = default;
  virtual void used(const SourceUse& use, const std::vector<SourceToken>& tokens) = 0;
};

class SourceScopes {
 public:
  // The keys ("enter", "when" ...) of the chart's functions, by the line where the function begins.
  using ChartFunctions = std::map<int, std::set<std::string>>;

  // `file` is its number among the files that share `facts`. `facts` must outlive this object.
  SourceScopes(std::vector<SourceToken> tokens, std::size_t file, SourceFacts& facts);
  // Gives the functions of the chart: only these are guards, end within their tick, or get `m` and `s`. Without this
  // call, every function counts as what its key says.
  void know_functions(ChartFunctions chart) { chart_ = std::move(chart); }
  // Reads the file once and adds to the facts.
  void read() { walk(nullptr); }
  void tell(SourceListener& listener) { walk(&listener); }

  // After tell(): all functions; the first is the file itself.
  std::vector<SourceFunction> functions() const;
  const std::vector<SourceToken>& tokens() const noexcept { return tokens_; }
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

  // source_facts.cpp: what an expression stands for.
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
  std::map<int, int> functions_by_line_;  // number of functions that begin on each line
  std::vector<Block> blocks_;
  std::vector<Braces> braces_;
  std::map<std::string, std::size_t> next_locals_;  // locals of the next block
  SourceListener* listener_ = nullptr;
};

// Reads the files until no new facts are learnt.
void learn_facts(const std::vector<SourceScopes*>& files, SourceFacts& facts);

}  // namespace kadans
