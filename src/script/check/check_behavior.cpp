#include "check_behavior.h"

#include <algorithm>
#include <iterator>
#include <tuple>

#include "check_source.h"
#include "hint.h"
#include "script/behavior/behavior_parts.h"
#include "script/chart/chart_reader.h"
#include "script/lua/lua_core.h"
#include "script/sandbox/sandbox.h"
#include "script/test/test_prelude.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;

const Catalog no_robot;

// What stands for the names of tests while a file is read: nothing is played, and no test runs.
constexpr char test_stubs[] =
    "local stub = setmetatable({}, { __index = function(t) return t end, __call = function(t) return t end })\n"
    "local function nothing() end\n"
    "return nothing, nothing, nothing, stub, stub";

struct Looked {
  Behavior::Parts& parts;
  CheckedScript found{};
  bool returned = false;
  bool unfinished = false;  // k.behavior "name" without its table
};

// Runs the file and looks at what it returns.
void look_at_file(lua_State* state, Looked& looked) {
  if (looked.found.kind == ScriptKind::test) {
    if (luaL_loadbuffer(state, test_stubs, sizeof test_stubs - 1, "=kadans test") != 0) lua_error(state);
    push_environment(state);
    lua_setfenv(state, -2);
    lua_call(state, 0, 5);
    open_test_names(state);
  }
  if (!looked.parts.lua->load_file(state, looked.parts.settings.file)) lua_error(state);
  lua_call(state, 0, 1);
  const std::optional<NodeKind> kind = node_kind(state, -1);
  looked.returned = !lua_isnil(state, -1);
  looked.unfinished = lua_iscfunction(state, -1) != 0;
  if (kind == NodeKind::behavior || kind == NodeKind::decisions) looked.found.kind = ScriptKind::behavior;
}

// expect(x).to_equal; `at` is behind the call.
Mistakes matcher_mistakes(const Tokens& tokens, std::size_t at) {
  const std::vector<std::string> known(std::begin(test_matchers), std::end(test_matchers));
  if (tokens[at].is(".") && tokens[at + 1].text == "never") at += 2;
  const SourceToken& name = tokens[at + 1];
  if (!tokens[at].is(".") || name.kind != TokenKind::name || std::ranges::find(known, name.text) != known.end())
    return {};
  return {{name.line, "expect(...) has no '" + name.text + "'" + hint_text(name.text, known)}};
}

// k.play "file" { options }; `at` is behind the name.
Mistakes play_mistakes(const Tokens& tokens, std::size_t at, const Behavior::Settings& settings) {
  Mistakes found;
  if (tokens[at].is("(")) ++at;
  if (tokens[at].kind != TokenKind::text) return found;
  const std::string& file = tokens[at].text;
  std::error_code ignored;
  if (!fs::exists(settings.file.parent_path() / file, ignored) && !fs::exists(settings.root / file, ignored))
    found.push_back(
        {tokens[at].line, "k.play: there is no " + file + " beside this file, nor from the project's root on"});
  if (!tokens[at + 1].is(",") || !tokens[at + 2].is("{")) return found;
  for (const std::size_t part : parts_of(tokens, at + 3)) {
    const SourceToken& key = tokens[part];
    if (key.kind == TokenKind::name && tokens[part + 1].is("=") && key.text != "robot" && key.text != "plant" &&
        key.text != "scenario")
      found.push_back({key.line, "k.play has no option '" + key.text + "'; there are: robot, plant, scenario"});
  }
  return found;
}

// What a test calls, as far as it is written out.
void check_test_calls(const LuaState::Source& source, const Behavior::Settings& settings,
                      std::vector<InputProblem>& problems) {
  Tokens tokens = lex_source(source.text);
  tokens.resize(tokens.size() + 4, SourceToken{TokenKind::end, "", tokens.back().line});
  const auto tell = [&](const Mistakes& found) {
    for (const SourceMistake& one : found) problems.push_back({source.chunk, one.line, 0, one.message});
  };
  for (std::size_t i = 0; tokens[i].kind != TokenKind::end; ++i) {
    const bool of_module = i > 0 && tokens[i - 1].is(".");
    if (tokens[i].is_name("expect") && tokens[i + 1].is("(") && !of_module)
      tell(matcher_mistakes(tokens, end_of_call(tokens, i + 2)));
    if (tokens[i].is_name("play") && of_module) tell(play_mistakes(tokens, i + 1, settings));
  }
}

void check_loaded(Looked& looked) {
  Behavior::Parts& parts = looked.parts;
  std::vector<InputProblem>& problems = looked.found.problems;
  const LuaState::Source& own = parts.lua->sources().front();
  check_sources(parts, problems);
  if (looked.found.kind == ScriptKind::test) {
    check_test_calls(own, parts.settings, problems);
  } else if (looked.unfinished) {
    problems.push_back({own.chunk, 1, 0, "returns a k.behavior without its table: return k.behavior \"name\" { ... }"});
  } else if (!looked.returned) {
    problems.push_back({own.chunk, 1, 0,
                        "returns nothing: a behavior returns k.behavior \"name\" { ... }, a module its "
                        "table"});
  }
}

}  // namespace

std::vector<InputProblem> check_behavior(const std::filesystem::path& root, const std::filesystem::path& file,
                                         const Catalog& catalog) {
  BehaviorLog silence;
  const Behavior::Settings settings{.root = root, .file = root / file};
  Behavior::Parts parts(settings, catalog, silence);
  std::vector<InputProblem> problems;
  try {
    load_behavior(parts, settings.limits.load_instructions);
    check_chart(parts.chart, problems);
    check_vars(parts, problems);
    check_livelocks(parts, problems);
    check_event_data(parts, problems);
    check_sources(parts, problems);
  } catch (const InputError& error) {
    return error.problems();
  }
  tell_once(problems);  // a behavior that is called twice
  return problems;
}

void tell_once(std::vector<InputProblem>& problems) {
  const auto key = [](const InputProblem& problem) { return std::tie(problem.file, problem.line, problem.message); };
  std::ranges::stable_sort(problems, {}, key);
  const auto same = [&](const InputProblem& a, const InputProblem& b) { return key(a) == key(b); };
  problems.erase(std::unique(problems.begin(), problems.end(), same), problems.end());
}

CheckedScript check_script(const fs::path& root, const fs::path& file, const Catalog* catalog) {
  BehaviorLog silence;
  const Behavior::Settings settings{.root = root, .file = root / file};
  Behavior::Parts parts(settings, catalog == nullptr ? no_robot : *catalog, silence);
  open_lua(parts);
  if (catalog != nullptr) parts.lua->core().bindings = &parts.bindings;
  Looked looked{parts};
  looked.found.kind = file.string().ends_with("_test.lua") ? ScriptKind::test : ScriptKind::module;
  try {
    parts.lua->call_or_throw([&](lua_State* state) { look_at_file(state, looked); }, settings.limits.load_instructions,
                             0);
    if (looked.found.kind == ScriptKind::behavior) {
      if (catalog != nullptr) looked.found.problems = check_behavior(root, file, *catalog);
    } else {
      check_loaded(looked);
    }
  } catch (const InputError& error) {
    looked.found.problems = error.problems();
  }
  tell_once(looked.found.problems);
  return looked.found;
}

}  // namespace kadans
