// Where the transitions of a chart stand in its source.
#include <algorithm>
#include <map>
#include <string>

#include "chart_reader.h"
#include "script/check/source_lexer.h"

namespace kadans {
namespace {

using Tokens = std::vector<SourceToken>;

// The opening brace of `k.state "name" {` from this line on; 0: not written so.
std::size_t body_of(const Tokens& tokens, int line, const std::string& name) {
  const auto first = std::ranges::lower_bound(tokens, line, {}, &SourceToken::line);
  for (auto i = static_cast<std::size_t>(first - tokens.begin()); i + 2 < tokens.size(); ++i) {
    if (tokens[i].kind != SourceToken::Kind::text || tokens[i].text != name) continue;
    const std::size_t behind = tokens[i + 1].is(")") ? i + 2 : i + 1;
    if (tokens[behind].is("{")) return behind;
  }
  return 0;
}

// Of the transition { ... to = "name" ... } at `at`; 0 when it is none.
std::size_t target_of(const Tokens& tokens, std::size_t at) {
  if (!tokens[at].is("{")) return 0;
  for (const std::size_t part : parts_of(tokens, at + 1)) {
    if (tokens[part].kind != SourceToken::Kind::name || tokens[part].text != "to") continue;
    return tokens[part + 1].is("=") && tokens[part + 2].kind == SourceToken::Kind::text ? part + 2 : 0;
  }
  return 0;
}

// Gives the transitions from `first` on their lines, those written in the braces at `at`, in their order.
void place(const Tokens& tokens, std::size_t at, Chart& chart, std::uint16_t first, std::uint16_t count) {
  std::vector<bool> placed(count, false);
  for (const std::size_t part : parts_of(tokens, at + 1)) {
    const std::size_t target = target_of(tokens, part);
    for (std::uint16_t i = 0; target != 0 && i < count; ++i) {
      Chart::Transition& transition = chart.transitions[static_cast<std::size_t>(first + i)];
      if (placed[i] || transition.target_name != tokens[target].text) continue;
      do {
        placed[i] = true;
        chart.transitions[static_cast<std::size_t>(first + i)].line = tokens[target].line;
        ++i;
      } while (i < count && chart.transitions[static_cast<std::size_t>(first + i)].listed);
      break;
    }
  }
}

std::size_t always_of(const Tokens& tokens, std::size_t at) {
  for (const std::size_t part : parts_of(tokens, at + 1)) {
    const bool found = tokens[part].kind == SourceToken::Kind::name && tokens[part].text == "always" &&
                       tokens[part + 1].is("=") && tokens[part + 2].is("{");
    if (found) return part + 2;
  }
  return 0;
}

}  // namespace

void find_transition_lines(const std::vector<LuaState::Source>& sources, Chart& chart) {
  std::map<std::string, Tokens> files;
  for (const Chart::State& state : chart.states) {
    if (state.transition_count == 0 && state.always_count == 0) continue;
    auto file = files.find(state.chunk);
    for (const LuaState::Source& source : sources) {
      if (file == files.end() && source.chunk == state.chunk)
        file = files.emplace(state.chunk, lex_source(source.text)).first;
    }
    if (file == files.end()) continue;
    const Tokens& tokens = file->second;
    const std::string& name = state.machine_root ? chart.machines[state.machine].name : state.name;
    const std::size_t body = body_of(tokens, state.line, name);
    if (body == 0) continue;
    place(tokens, body, chart, state.first_transition, state.transition_count);
    const std::size_t always = state.always_count > 0 ? always_of(tokens, body) : 0;
    if (always != 0) place(tokens, always, chart, state.first_always, state.always_count);
  }
}

}  // namespace kadans
