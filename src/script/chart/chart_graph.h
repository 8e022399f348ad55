// Draws a chart as Graphviz dot or as a Mermaid state diagram. Nested states are inside their parents, parallel regions
// beside each other, as UML has it: a filled circle leads to what is entered first, H and H* are histories, a bar leads
// into several regions, and an action alone is a line in its state. The label of a transition shows its event, its
// time, "[when]" for a guard, and its reason; «always» and {local} (internal = true) are marked.
#pragma once

#include <string>
#include <vector>

#include "chart.h"
#include "script/host/script_declarations.h"

namespace kadans {

// `parameters` gives the names of times that come from k.params.
std::string dot_graph(const Chart& chart, const std::vector<ScriptParameter>& parameters);
std::string mermaid_graph(const Chart& chart, const std::vector<ScriptParameter>& parameters);

// The label of a transition: "run.done", "after settle_s, [when] (lost balance)".
std::string transition_label(const Chart& chart, const Chart::Transition& transition,
                             const std::vector<ScriptParameter>& parameters);

}  // namespace kadans
