// The checks of a loaded behavior: of the shape of its chart, of its modules, and of the text in every branch.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "known_names.h"
#include "script/behavior/behavior_parts.h"
#include "script/chart/chart.h"
#include "source_scopes.h"

namespace kadans {

// A loaded file and its parsed text.
struct ReadSource {
  const LuaState::Source* source = nullptr;
  SourceScopes scopes;
};

// A mistake in the text of one file.
struct SourceMistake {
  int line = 0;
  std::string message;
};
using Mistakes = std::vector<SourceMistake>;

// Checks a literal argument that is the name of a pose, and the literal arguments of an object's method. `at` is the
// first token of the arguments.
Mistakes pose_mistakes(const Catalog& catalog, const Tokens& tokens, std::size_t at);
Mistakes argument_mistakes(const Catalog& catalog, const ObjectInfo& object, const std::string& method,
                           const Tokens& tokens, std::size_t at);
// Checks what stands around the uses of names, and values that are written out.
Mistakes value_mistakes(const Behavior::Parts& parts, const std::vector<SourceUse>& uses, const Tokens& tokens);
// Compares the formats of string.format and k.log with the values behind them, as far as they are written out. `at` is
// the first token in the brackets of the call. "" when nothing is wrong.
std::string format_mistake(const Tokens& tokens, std::size_t at, const std::string& called);
// print("x %d", 1)
std::string print_mistake(const Tokens& tokens, std::size_t at);
// Checks how a script goes on. `of_behavior`: the file is a behavior's own, no module.
Mistakes flow_mistakes(const Catalog& catalog, const KnownNames& known, bool of_behavior,
                       const std::vector<SourceUse>& uses, const Tokens& tokens);

// Finds mistakes by reading the text of a behavior, in every branch: unknown names (fields of m and s, control objects,
// set-points, presets, parameters, poses, vars, globals, own modules), values out of range, guards that write or return
// nothing, waits in places that cannot wait, and events that are never emitted.
// Checks the file of a loaded behavior, or a module, and all files that it requires and calls.
void check_sources(Behavior::Parts& parts, std::vector<InputProblem>& problems);

// Finds mistakes in the shape of a chart that could still run: states that cannot be reached, states without a way out,
// final states without an outcome, transitions that can never be taken.
// The chart must be resolved and free of other problems.
void check_chart(const Chart& chart, std::vector<InputProblem>& problems);

// Finds transitions on an event that is never emitted: neither by a function of the behavior or of the files that it
// requires and calls, nor by a final state inside the waiting state.
// Finds also events that a behavior's own file declares in k.events, and that nothing waits for or emits.
void check_events(const Chart& chart, const std::vector<ScriptEvent>& declared, const std::vector<ReadSource>& read,
                  std::vector<InputProblem>& problems);

// Of a function of the chart: which one it is, and where it is written.
struct ChartFunction {
  const void* identity = nullptr;
  std::string chunk;
  int line = 0;
};

// What states enter with, and the guards and actions of transitions, by their references; and the tokens of all files,
// with some behind their end to look ahead.
struct ChartFunctions {
  // Where a function begins in its tokens; at 0: it is not the only one that begins in its line, or none.
  struct Begin {
    const Tokens& tokens;
    std::size_t at;
  };
  Begin begin_of(const ChartFunction& function) const;

  const Chart& chart;
  bool known = false;  // all were read
  std::map<int, ChartFunction> by_reference{};
  std::map<std::string, Tokens> files{};
};
ChartFunctions chart_functions(Behavior::Parts& parts);

// Finds guards and actions that read data of an event where there is none, or a field that may be missing as if it
// were always there.
void check_event_data(Behavior::Parts& parts, std::vector<InputProblem>& problems);

// Finds states that lead to each other for ever and take no time.
void check_livelocks(Behavior::Parts& parts, std::vector<InputProblem>& problems);

// Checks that `vars`, `args` and the arguments of k.call are plain data, because entering copies them and a reload
// keeps them. Anything else would raise as soon as the behavior is entered.
// `parts` is a loaded behavior.
void check_vars(Behavior::Parts& parts, std::vector<InputProblem>& problems);

}  // namespace kadans
