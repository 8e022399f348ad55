#include "chart_graph.h"

#include <array>
#include <cstdio>

namespace kadans {
namespace {

std::string id(StateIndex state) { return "s" + std::to_string(state); }

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + '"';
}

std::string seconds(double time_s) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%g s", time_s);
  return text.data();
}

class Graph {
 public:
  Graph(const Chart& chart, const std::vector<ScriptParameter>& parameters) : chart_(chart), parameters_(parameters) {}

  std::string label(const Chart::Transition& transition) const {
    std::string text;
    const auto add = [&text](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
    if (transition.on != no_event) add(chart_.events[static_cast<std::size_t>(transition.on)]);
    if (transition.timed && transition.after_parameter != Chart::no_parameter) {
      add("after " + parameters_.at(static_cast<std::size_t>(transition.after_parameter)).name);
    } else if (transition.timed) {
      add("after " + seconds(transition.after_s));
    }
    if (transition.when != Chart::no_function) add("[when]");
    const bool told =
        transition.why == "after" || transition.why == "when" ||
        (transition.on != no_event && transition.why == chart_.events[static_cast<std::size_t>(transition.on)]);
    if (!transition.why.empty() && !told) text += " (" + transition.why + ")";
    return text;
  }
  bool has_children(StateIndex state) const { return chart_.states[state].end > state + 1; }
  // The first child, then each next one.
  template <typename Visit>
  void each_child(StateIndex state, Visit visit) const {
    const StateIndex end = chart_.states[state].end;
    for (StateIndex child = static_cast<StateIndex>(state + 1); child < end; child = chart_.states[child].end) {
      visit(child);
    }
  }
  std::string title(StateIndex state) const {
    const Chart::State& s = chart_.states[state];
    if (s.kind == Chart::Kind::history) return s.deep ? "H*" : "H";
    if (s.kind == Chart::Kind::final_state && s.outcome_name != s.name) return s.name + ": " + s.outcome_name;
    std::string sets;
    for (const std::string& set : s.controls) sets += (sets.empty() ? " [" : ", ") + set;
    return sets.empty() ? s.name : s.name + sets + "]";
  }
  // Graphviz draws arrows between leaves; one that belongs to a compound state starts or ends at its border.
  StateIndex leaf(StateIndex state) const {
    while (has_children(state)) {
      const StateIndex initial = chart_.states[state].initial;
      state = initial != no_state ? initial : static_cast<StateIndex>(state + 1);
    }
    return state;
  }
  const Chart& chart() const { return chart_; }

 private:
  const Chart& chart_;
  const std::vector<ScriptParameter>& parameters_;
};

void write_dot_state(const Graph& graph, StateIndex state, const std::string& indent, std::string& text) {
  const Chart::State& s = graph.chart().states[state];
  if (!graph.has_children(state)) {
    const char* shape = s.kind == Chart::Kind::final_state ? "doublecircle"
                        : s.kind == Chart::Kind::history   ? "circle"
                                                           : "box";
    text += indent + id(state) + " [label=" + quoted(graph.title(state)) + ", shape=" + shape + "];\n";
    return;
  }
  const char* style = s.kind == Chart::Kind::region ? "dashed" : "rounded";
  text += indent + "subgraph cluster_" + id(state) + " {\n" + indent + "  label=" + quoted(graph.title(state)) +
          "; style=" + style + ";\n";
  graph.each_child(state, [&](StateIndex child) { write_dot_state(graph, child, indent + "  ", text); });
  text += indent + "}\n";
}

void write_mermaid_state(const Graph& graph, StateIndex state, const std::string& indent, std::string& text) {
  const Chart::State& s = graph.chart().states[state];
  if (s.kind == Chart::Kind::region) {
    if (state != s.parent + 1) text += indent + "--\n";  // between regions
  } else if (state != 0) {
    text += indent + "state " + quoted(graph.title(state)) + " as " + id(state);
    text += graph.has_children(state) ? " {\n" : "\n";
  }
  const bool braces = state != 0 && s.kind != Chart::Kind::region && graph.has_children(state);
  const std::string inner = braces ? indent + "  " : indent;
  if (s.initial != no_state && s.kind != Chart::Kind::history) text += inner + "[*] --> " + id(s.initial) + "\n";
  graph.each_child(state, [&](StateIndex child) { write_mermaid_state(graph, child, inner, text); });
  if (s.kind == Chart::Kind::final_state) text += indent + id(state) + " --> [*]\n";
  if (braces) text += indent + "}\n";
}

}  // namespace

std::string dot_graph(const Chart& chart, const std::vector<ScriptParameter>& parameters) {
  const Graph graph(chart, parameters);
  std::string text = "digraph " + quoted(chart.name) + " {\n  compound=true; rankdir=LR;\n" +
                     "  node [fontname=sans, style=rounded]; edge [fontname=sans, fontsize=10];\n" +
                     "  start [shape=point];\n";
  graph.each_child(0, [&](StateIndex child) { write_dot_state(graph, child, "  ", text); });
  if (chart.states.front().initial != no_state)
    text += "  start -> " + id(graph.leaf(chart.states.front().initial)) + ";\n";
  for (const Chart::Transition& transition : chart.transitions) {
    if (transition.target == no_state) continue;
    text += "  " + (transition.source == 0 ? "start" : id(graph.leaf(transition.source))) + " -> " +
            id(graph.leaf(transition.target)) + " [label=" + quoted(graph.label(transition));
    if (transition.source == 0) text += ", style=dashed";  // whatever the state
    if (transition.source != 0 && graph.has_children(transition.source))
      text += ", ltail=cluster_" + id(transition.source);
    if (graph.has_children(transition.target)) text += ", lhead=cluster_" + id(transition.target);
    text += "];\n";
  }
  return text + "}\n";
}

std::string mermaid_graph(const Chart& chart, const std::vector<ScriptParameter>& parameters) {
  const Graph graph(chart, parameters);
  std::string text = "stateDiagram-v2\n";
  write_mermaid_state(graph, 0, "  ", text);
  for (const Chart::Transition& transition : chart.transitions) {
    if (transition.target == no_state) continue;
    const std::string from = transition.source == 0 ? "[*]" : id(transition.source);
    const std::string label = graph.label(transition);
    text += "  " + from + " --> " + id(transition.target) + (label.empty() ? "" : ": " + label) + "\n";
  }
  return text;
}

std::string transition_label(const Chart& chart, const Chart::Transition& transition,
                             const std::vector<ScriptParameter>& parameters) {
  return Graph(chart, parameters).label(transition);
}

}  // namespace kadans
