// What is known of a behavior's functions, tables and modules once all its files were read: which function a field
// holds, what a module returns, what a function is given.
//
// A name stands for a value when that is the only one it is given anywhere. Files are read again until nothing new is
// learnt, in three phases: see SourceFacts::Phase.
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

// A token of one of the files.
struct SourcePlace {
  std::size_t file = 0, token = 0;
  auto operator<=>(const SourcePlace&) const = default;
};

// What an expression stands for: `m.posture` is {machine, {"posture"}}, `legs.bend` of the author's module "legs"
// {own_module, {"legs", "bend"}}, field `w` of a table that is written at `place` {table, {"w"}, place}.
struct SourceMeaning {
  SourceRole role = SourceRole::none;
  std::vector<std::string> path{};
  SourcePlace place{};  // where a function or table is written; of parameters: their file
  bool operator==(const SourceMeaning&) const = default;
};

class SourceFacts {
 public:
  enum class Phase : std::uint8_t {
    values,   // what names stand for; a value that nobody knows may be known after the next reading
    unknown,  // it never will be: the names that are given it stand for nothing
    calls     // names are settled: which functions run in guards, and which are over within their tick
  };
  struct Function {
    int line = 0;
    bool in_chart = false;                       // may be one of the chart's
    std::map<std::size_t, SourceMeaning> given;  // by the number of the parameter; 0 is `self` of a method
    bool guard = false;                          // or called by one
    bool under_when = false;
    bool returns_value = false;   // by a `return` of its own
    std::set<SourcePlace> tails;  // the functions whose values it returns: `return f(x)`
    int returns = 0;              // that stand before what is read, or right before it
    bool literal = false;         // of `at_once`: stands under the key itself
    std::string at_once;
  };

  void name_module(const std::string& name, std::size_t file) { modules_[name] = file; }

  // Each: another value of it, or the same one again. A value of role `none` is one that nobody knows.
  void give_local(SourcePlace name, const SourceMeaning& value) { learn(locals_, name, value); }
  void give_field(const SourceMeaning& table, const std::string& field, const SourceMeaning& value);
  void give_parameter(SourcePlace function, std::size_t number, const SourceMeaning& value);
  void give_module(std::size_t file, const SourceMeaning& returned) { learn(returned_, file, returned); }
  // A field of a table that nobody knows.
  void give_somewhere(const std::string& field) { given_somewhere_.insert(field); }

  SourceMeaning local(SourcePlace name) const;
  // What it stands for, looked up in tables and modules as far as they are known. `written`: how many of the path's
  // last fields stand where it is used, before and after.
  SourceMeaning resolve(const SourceMeaning& meaning, std::size_t& written) const;
  SourceMeaning resolve(const SourceMeaning& meaning) const;
  // Whether a call of it has a value, as far as is known.
  bool returns_value(SourcePlace function) const;
  // That a module of the author's own is given in any file.
  std::vector<std::string> fields_of(const std::string& module) const;
  const std::set<std::string>& given_somewhere() const noexcept { return given_somewhere_; }

  std::map<SourcePlace, Function> functions;  // by the token `function`; a file is one itself, by its first token
  Phase phase = Phase::values;
  bool learnt = false;  // since it was set to false

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
