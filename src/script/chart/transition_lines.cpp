// Where the transitions of a chart stand in its source.
#include <algorithm>
#include <map>
#include <string>

#include "chart_reader.h"
#include "script/check/source_lexer.h"

namespace kadans {
namespace {

// The opening brace of `k.state "name" {` from this line on; 0: not written so.
std::size_t body_of(const Tokens& tokens, int line, const std::string& name) {
  const auto first = std::ranges::lower_bound(tokens, line, {}, &SourceToken::line);
  for (auto i = static_cast<std::size_t>(first - tokens.begin()); i + 2 < tokens.size(); ++i) {
    if (tokens[i].kind != TokenKind::text || tokens[i].text != name) continue;
    const std::size_t behind = tokens[i + 1].is(")") ? i + 2 : i + 1;
    if (tokens[behind].is("{")) return behind;
  }
  return 0;
}

// The name of the first target of the transition { ... to = "name" ... } at `at`; the brace when it has no `to`; 0 when
// it is none, or its target is not written so.
std::size_t target_of(const Tokens& tokens, std::size_t at) {
  if (!tokens[at].is("{")) return 0;
  for (const std::size_t part : parts_of(tokens, at + 1)) {
    if (!tokens[part].is_name("to")) continue;
    if (!tokens[part + 1].is("=")) return 0;
    const std::size_t first = tokens[part + 2].is("{") ? part + 3 : part + 2;
    return tokens[first].kind == TokenKind::text ? first : 0;
  }
  return at;
}

// Whether the one of this chart may be written there.
bool fits(const Chart::Transition& transition, const SourceToken& target) {
  const bool without = target.is("{");
  return transition.target_names.empty() ? without : !without && transition.target_names.front() == target.text;
}

// Gives the transitions from `first` on their lines, those written in the braces at `at`, in their order.
void place(const Tokens& tokens, std::size_t at, Chart& chart, std::uint16_t first, std::uint16_t count) {
  std::vector<bool> placed(count, false);
  for (const std::size_t part : parts_of(tokens, at + 1)) {
    const std::size_t target = target_of(tokens, part);
    for (std::uint16_t i = 0; target != 0 && i < count; ++i) {
      if (placed[i] || !fits(chart.transitions[static_cast<std::size_t>(first + i)], tokens[target])) continue;
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
    if (tokens[part].is_name("always") && tokens[part + 1].is("=") && tokens[part + 2].is("{")) return part + 2;
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
