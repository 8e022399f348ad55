#include "chart_graph.h"

#include "signal/number_text.h"

namespace kadans {
namespace {

std::string id(StateIndex state) { return "s" + std::to_string(state); }

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    if (c == '\n') result += "\\n";
    if (c != '\n') result += c;
  }
  return result + '"';
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
      add(printed("after %g s", transition.after_s));
    }
    if (transition.when != Chart::no_function) add("[when]");
    const bool told =
        transition.why == "after" || transition.why == "when" ||
        (transition.on != no_event && transition.why == chart_.events[static_cast<std::size_t>(transition.on)]);
    if (!transition.why.empty() && !told) text += " (" + transition.why + ")";
    return text;
  }
  // The same with what the chart around it tells: an `always`, a transition that does not leave its state.
  std::string whole_label(const Chart::Transition& transition) const {
    const Chart::State& source = chart_.states[transition.source];
    const auto number = static_cast<std::size_t>(&transition - chart_.transitions.data());
    std::string text = label(transition);
    if (number >= source.first_always && number < std::size_t{source.first_always} + source.always_count)
      text = text.empty() ? "«always»" : "«always» " + text;
    return transition.internal ? text + (text.empty() ? "{local}" : " {local}") : text;
  }
  // What a state does without being left, a line each: UML's internal transitions.
  std::vector<std::string> actions_alone(StateIndex state) const {
    std::vector<std::string> lines;
    for (const Chart::Transition& one : chart_.transitions_of(chart_.states[state])) {
      if (one.target == no_state) lines.push_back(whole_label(one) + " / action");
    }
    return lines;
  }
  // With these lines below it.
  std::string full_title(StateIndex state, const char* break_text) const {
    std::string text = title(state);
    for (const std::string& line : actions_alone(state)) text += break_text + line;
    return text;
  }
  // Leads into its own source.
  bool inwards(const Chart::Transition& one) const {
    return one.source != 0 && one.target != one.source && chart_.inside(one.target, one.source);
  }
  bool has_children(StateIndex state) const { return chart_.states[state].end > state + 1; }
  std::string title(StateIndex state) const {
    const Chart::State& s = chart_.states[state];
    if (s.kind == Chart::Kind::history) return s.deep ? "H*" : "H";
    if (s.kind == Chart::Kind::final_state && s.outcome_name != s.name) return s.name + ": " + s.outcome_name;
    return s.controls.empty() ? s.name : s.name + " [" + listed(s.controls) + "]";
  }
  // Graphviz draws arrows between leaves; one that belongs to a compound state starts or ends at its border.
  StateIndex leaf(StateIndex state) const {
    while (has_children(state)) {
      const StateIndex initial = chart_.states[state].initial;
      auto first = static_cast<StateIndex>(state + 1);
      while (first + 1 < chart_.states[state].end && chart_.states[first].kind == Chart::Kind::history) ++first;
      state = initial != no_state ? initial : first;
    }
    return state;
  }
  const Chart& chart() const { return chart_; }

 private:
  const Chart& chart_;
  const std::vector<ScriptParameter>& parameters_;
};

// A filled circle leads to what a state enters first; a history to what it enters when there is nothing to remember.
void write_dot_defaults(const Graph& graph, StateIndex state, const std::string& indent, std::string& text) {
  const Chart::State& s = graph.chart().states[state];
  const bool history = s.kind == Chart::Kind::history;
  if (s.defaults.empty() || (history && s.initial_names.empty())) return;
  const std::string from = history ? id(state) : "i" + std::to_string(state);
  if (!history) text += indent + from + " [shape=point];\n";
  for (const StateIndex target : s.defaults) {
    text += indent + from + " -> " + id(graph.leaf(target));
    if (graph.has_children(target)) text += " [lhead=cluster_" + id(target) + "]";
    text += ";\n";
  }
}

void write_dot_state(const Graph& graph, StateIndex state, const std::string& indent, std::string& text) {
  const Chart::State& s = graph.chart().states[state];
  if (!graph.has_children(state)) {
    const char* shape = s.kind == Chart::Kind::final_state ? "doublecircle"
                        : s.kind == Chart::Kind::history   ? "circle"
                                                           : "box";
    text += indent + id(state) + " [label=" + quoted(graph.full_title(state, "\n")) + ", shape=" + shape + "];\n";
    return write_dot_defaults(graph, state, indent, text);
  }
  const char* style = s.kind == Chart::Kind::region ? "dashed" : "rounded";
  text += indent + "subgraph cluster_" + id(state) + " {\n" + indent +
          "  label=" + quoted(graph.full_title(state, "\n")) + "; style=" + style + ";\n";
  write_dot_defaults(graph, state, indent + "  ", text);
  graph.chart().each_child(state, [&](StateIndex child) { write_dot_state(graph, child, indent + "  ", text); });
  text += indent + "}\n";
}

// From the border of a compound state. A transition into its own source begins at a point: inside of it when the source
// is not left, else outside.
std::string write_dot_source(const Graph& graph, const Chart::Transition& one, std::size_t number, std::string& text) {
  if (one.source == 0) return "start";
  if (!graph.inwards(one)) return id(graph.leaf(one.source));
  const std::string point = "p" + std::to_string(number), cluster = "cluster_" + id(one.source);
  if (one.internal) {
    text += "  subgraph " + cluster + " { " + point + " [shape=point, width=0.03]; }\n";
  } else {
    text += "  " + point + " [shape=point, width=0.03];\n  " + id(graph.leaf(one.source)) + " -> " + point +
            " [ltail=" + cluster + ", arrowhead=none];\n";
  }
  return point;
}

void write_dot_transition(const Graph& graph, const Chart::Transition& one, std::size_t number, std::string& text) {
  std::string from = write_dot_source(graph, one, number, text);
  std::string style = "label=" + quoted(graph.whole_label(one));
  if (one.source == 0) style += ", style=dashed";  // whatever the state
  if (one.source != 0 && graph.has_children(one.source) && !graph.inwards(one))
    style += ", ltail=cluster_" + id(one.source);
  const auto arrow = [&](StateIndex target) {
    text += "  " + from + " -> " + id(graph.leaf(target)) + " [" + style;
    if (graph.has_children(target)) text += std::string(style.empty() ? "" : ", ") + "lhead=cluster_" + id(target);
    text += "];\n";
  };
  if (!one.also.empty()) {  // a bar, from which an arrow leads into each region
    const std::string bar = "f" + std::to_string(number);
    text += "  " + bar + " [shape=box, style=filled, fillcolor=black, label=\"\", width=0.05, height=0.5];\n  " + from +
            " -> " + bar + " [" + style + "];\n";
    from = bar;
    style.clear();
  }
  one.each_target(arrow);
}

void write_mermaid_state(const Graph& graph, StateIndex state, const std::string& indent, std::string& text) {
  const Chart::State& s = graph.chart().states[state];
  const bool history = s.kind == Chart::Kind::history;
  if (s.kind == Chart::Kind::region) {
    bool first = true;
    graph.chart().each_region(s.parent, [&](StateIndex region) { first = first && region >= state; });
    if (!first) text += indent + "--\n";  // between regions
  } else if (state != 0) {
    text += indent + "state " + quoted(graph.full_title(state, "<br/>")) + " as " + id(state);
    text += graph.has_children(state) ? " {\n" : "\n";
  }
  const bool braces = state != 0 && s.kind != Chart::Kind::region && graph.has_children(state);
  const std::string inner = braces ? indent + "  " : indent;
  if (!history || !s.initial_names.empty()) {
    for (const StateIndex target : s.defaults)
      text += inner + (history ? id(state) : "[*]") + " --> " + id(target) + "\n";
  }
  graph.chart().each_child(state, [&](StateIndex child) { write_mermaid_state(graph, child, inner, text); });
  if (s.kind == Chart::Kind::final_state) text += indent + id(state) + " --> [*]\n";
  if (braces) text += indent + "}\n";
}

void write_mermaid_transition(const Graph& graph, const Chart::Transition& one, std::size_t number, std::string& text) {
  std::string from = one.source == 0 ? "[*]" : id(one.source);
  std::string label = graph.whole_label(one);
  const auto arrow = [&](const std::string& to) {
    text += "  " + from + " --> " + to + (label.empty() ? "" : ": " + label) + "\n";
  };
  if (!one.also.empty()) {
    const std::string bar = "f" + std::to_string(number);
    text += "  state " + bar + " <<fork>>\n";
    arrow(bar);
    from = bar;
    label.clear();
  }
  one.each_target([&](StateIndex target) { arrow(id(target)); });
}

}  // namespace

std::string dot_graph(const Chart& chart, const std::vector<ScriptParameter>& parameters) {
  const Graph graph(chart, parameters);
  std::string text = "digraph " + quoted(chart.name) + " {\n  compound=true; rankdir=LR;\n" +
                     "  node [fontname=sans, style=rounded]; edge [fontname=sans, fontsize=10];\n" +
                     "  start [shape=point];\n";
  if (!graph.actions_alone(0).empty()) text += "  label=" + quoted(graph.full_title(0, "\n")) + "; labelloc=t;\n";
  chart.each_child(0, [&](StateIndex child) { write_dot_state(graph, child, "  ", text); });
  for (const StateIndex target : chart.states.front().defaults) {
    text += "  start -> " + id(graph.leaf(target)) + ";\n";
  }
  for (std::size_t i = 0; i < chart.transitions.size(); ++i) {
    if (chart.transitions[i].target != no_state) write_dot_transition(graph, chart.transitions[i], i, text);
  }
  return text + "}\n";
}

std::string mermaid_graph(const Chart& chart, const std::vector<ScriptParameter>& parameters) {
  const Graph graph(chart, parameters);
  std::string text = "stateDiagram-v2\n";
  write_mermaid_state(graph, 0, "  ", text);
  for (std::size_t i = 0; i < chart.transitions.size(); ++i) {
    if (chart.transitions[i].target != no_state) write_mermaid_transition(graph, chart.transitions[i], i, text);
  }
  for (const std::string& line : graph.actions_alone(0)) text += "  %% in any state: " + line + "\n";
  return text;
}

std::string transition_label(const Chart& chart, const Chart::Transition& transition,
                             const std::vector<ScriptParameter>& parameters) {
  return Graph(chart, parameters).label(transition);
}

}  // namespace kadans
