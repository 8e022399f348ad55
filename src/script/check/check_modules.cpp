#include "check_modules.h"

#include <algorithm>
#include <set>

namespace kadans {
namespace {

using Kind = SourceToken::Kind;
using Tokens = std::vector<SourceToken>;

// The local that a file ends with returning, or "".
std::string returned_name(const Tokens& tokens) {
  std::size_t end = tokens.size();
  while (end > 0 && (tokens[end - 1].kind == Kind::end || tokens[end - 1].is(";"))) --end;
  const bool named = end >= 2 && tokens[end - 1].kind == Kind::name && tokens[end - 2].is("return");
  return named ? tokens[end - 1].text : "";
}

std::size_t end_of_bracket(const Tokens& tokens, std::size_t at) {
  int depth = 0;
  for (; tokens[at].kind != Kind::end; ++at) {
    depth += tokens[at].is("[") ? 1 : tokens[at].is("]") ? -1 : 0;
    if (depth == 0) break;
  }
  return at;
}

// Whether a function writes `name[computed] = ` or hands it to rawset.
bool filled_while_it_runs(const Tokens& tokens, const std::string& name) {
  std::vector<bool> blocks;  // whether each is a function's
  for (std::size_t i = 0; i + 2 < tokens.size(); ++i) {
    const SourceToken& token = tokens[i];
    if (token.is("function") || token.is("if") || token.is("do") || token.is("repeat"))
      blocks.push_back(token.is("function"));
    if ((token.is("end") || token.is("until")) && !blocks.empty()) blocks.pop_back();
    if (std::ranges::find(blocks, true) == blocks.end() || token.kind != Kind::name) continue;
    if (token.text == "rawset" && tokens[i + 2].text == name) return true;
    if (token.text == name && tokens[i + 1].is("[") && tokens[end_of_bracket(tokens, i + 1) + 1].is("=")) return true;
  }
  return false;
}

const ReadSource* file_of(const std::vector<ReadSource>& read, const LuaState& lua, const std::string& module) {
  const std::filesystem::path path = lua.find_module(module);
  const auto found = std::ranges::find_if(read, [&](const ReadSource& one) { return one.source->path == path; });
  return path.empty() || found == read.end() ? nullptr : &*found;
}

// Whether what `require` at the token gives is used.
bool uses_value(const Tokens& tokens, std::size_t at) {
  const std::size_t arguments = tokens[at + 1].is("(") ? at + 2 : at + 1;
  const SourceToken& after = tokens[end_of_call(tokens, arguments)];
  if (after.is(".") || after.is("(") || after.is(":") || after.is("[")) return true;
  if (at == 0) return false;
  const SourceToken& before = tokens[at - 1];
  for (const char* word : {"=", "(", ",", "{", "return", "and", "or", "not", "..", "=="}) {
    if (before.is(word)) return true;
  }
  return false;
}

}  // namespace

void name_modules(const std::vector<ReadSource>& read, const LuaState& lua, const KnownNames& known,
                  SourceFacts& facts) {
  for (const auto& [name, ignored] : known.modules) {
    if (const ReadSource* const file = file_of(read, lua, name)) facts.name_module(name, file->scopes.file());
  }
}

void widen_modules(const std::vector<ReadSource>& read, const LuaState& lua, const SourceFacts& facts,
                   KnownNames& known) {
  known.given_somewhere = facts.given_somewhere();
  for (auto& [name, module] : known.modules) {
    for (const std::string& field : facts.fields_of(name)) module.fields.try_emplace(field);
    const ReadSource* const file = file_of(read, lua, name);
    if (file == nullptr) continue;
    const std::string table = returned_name(file->scopes.tokens());
    module.open = module.open || (!table.empty() && filled_while_it_runs(file->scopes.tokens(), table));
  }
}

void check_module_values(const std::vector<ReadSource>& read, const LuaState& lua,
                         std::vector<InputProblem>& problems) {
  for (const ReadSource& one : read) {
    const Tokens& tokens = one.scopes.tokens();
    for (std::size_t i = 0; i + 2 < tokens.size(); ++i) {
      if (tokens[i].kind != Kind::name || tokens[i].text != "require" || !uses_value(tokens, i)) continue;
      const SourceToken& name = tokens[i + 1].is("(") ? tokens[i + 2] : tokens[i + 1];
      const ReadSource* const file = name.kind == Kind::text ? file_of(read, lua, name.text) : nullptr;
      if (file == nullptr || file->scopes.functions().front().returns_value) continue;
      problems.push_back({file->source->chunk, file->scopes.tokens().back().line, 0,
                          "returns nothing, and " + one.source->chunk + ":" + std::to_string(tokens[i].line) +
                              " uses what it returns: end it with return and its table"});
    }
  }
}

void check_guard_values(const std::vector<ReadSource>& read, const KnownNames& known,
                        std::vector<InputProblem>& problems) {
  for (const ReadSource& one : read) {
    const std::vector<SourceFunction> functions = one.scopes.functions();
    const auto tell = [&](int line) {
      problems.push_back(
          {one.source->chunk, line, 0, "a guard that returns nothing is never true: return its condition"});
    };
    for (const SourceFunction& function : functions) {
      if (function.guard && !function.returns_value) tell(function.line);
    }
    const auto chart = known.functions.find(one.source->chunk);
    if (chart == known.functions.end()) continue;
    for (const auto& [at, keys] : chart->second) {  // all that begin there: which of them it is cannot be told
      if (!keys.contains("when")) continue;
      const int line = at;
      const auto begins = [line](const SourceFunction& function) { return function.line == line; };
      const auto returns = [&](const SourceFunction& function) { return begins(function) && function.returns_value; };
      if (std::ranges::any_of(functions, begins) && std::ranges::none_of(functions, returns)) tell(line);
    }
  }
}

}  // namespace kadans
