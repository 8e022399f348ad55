// A chart as a picture: Graphviz dot, or a Mermaid state diagram. Nested states stand inside their parents, parallel
// regions beside each other; a transition says what takes it: its event, its time, "[when]" for a guard, and why.
#pragma once

#include <string>
#include <vector>

#include "kadans/script/chart.h"
#include "kadans/script/script_parameter.h"

namespace kadans {

// `parameters` name the times that come from k.params.
std::string dot_graph(const Chart& chart, const std::vector<ScriptParameter>& parameters);
std::string mermaid_graph(const Chart& chart, const std::vector<ScriptParameter>& parameters);

// What takes it, in words: "run.done", "after settle_s, [when] (lost balance)".
std::string transition_label(const Chart& chart, const Chart::Transition& transition,
                             const std::vector<ScriptParameter>& parameters);

}  // namespace kadans
