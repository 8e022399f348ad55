
#include "check_source.h"

#include <algorithm>
#include <array>

#include "foreign_words.h"
#include "hint.h"
#include "script/bindings/machine_sets.h"
#include "source_scopes.h"

namespace kadans {
namespace {

// The local that a file ends with returning, or "".
std::string returned_name(const Tokens& tokens) {
  std::size_t end = tokens.size();
  while (end > 0 && (tokens[end - 1].kind == TokenKind::end || tokens[end - 1].is(";"))) --end;
  const bool named = end >= 2 && tokens[end - 1].kind == TokenKind::name && tokens[end - 2].is("return");
  return named ? tokens[end - 1].text : "";
}

// Whether a function writes `name[computed] = ` or hands it to rawset.
bool filled_while_it_runs(const Tokens& tokens, const std::string& name) {
  std::vector<bool> blocks;  // whether each is a function's
  for (std::size_t i = 0; i + 2 < tokens.size(); ++i) {
    const SourceToken& token = tokens[i];
    const int change = opens_block(token);
    if (change > 0) blocks.push_back(token.is("function"));
    if (change < 0 && !blocks.empty()) blocks.pop_back();
    if (std::ranges::find(blocks, true) == blocks.end() || token.kind != TokenKind::name) continue;
    if (token.text == "rawset" && tokens[i + 2].text == name) return true;
    if (token.text == name && tokens[i + 1].is("[") && tokens[end_of_block(tokens, i + 1) + 1].is("=")) return true;
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
  return before.is_any({"=", "(", ",", "{", "return", "and", "or", "not", "..", "=="});
}

// Tells the facts which file each name in `require` means.
void name_modules(const std::vector<ReadSource>& read, const LuaState& lua, const KnownNames& known,
                  SourceFacts& facts) {
  for (const auto& [name, ignored] : known.modules) {
    if (const ReadSource* const file = file_of(read, lua, name)) facts.name_module(name, file->scopes.file());
  }
}

// Adds all fields to a module that are assigned to it anywhere. A module that is filled by computed names may have any
// field.
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

// Finds modules whose value is used although they return nothing.
void check_module_values(const std::vector<ReadSource>& read, const LuaState& lua,
                         std::vector<InputProblem>& problems) {
  for (const ReadSource& one : read) {
    const Tokens& tokens = one.scopes.tokens();
    for (std::size_t i = 0; i + 2 < tokens.size(); ++i) {
      if (!tokens[i].is_name("require") || !uses_value(tokens, i)) continue;
      const SourceToken& name = tokens[i + 1].is("(") ? tokens[i + 2] : tokens[i + 1];
      const ReadSource* const file = name.kind == TokenKind::text ? file_of(read, lua, name.text) : nullptr;
      if (file == nullptr || file->scopes.functions().front().returns_value) continue;
      problems.push_back({file->source->chunk, file->scopes.tokens().back().line, 0,
                          "returns nothing, and " + one.source->chunk + ":" + std::to_string(tokens[i].line) +
                              " uses what it returns: end it with return and its table"});
    }
  }
}

// Finds guards that return no value, in any file.
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
    for (const auto& [at, begun] : chart->second) {  // all that begin there: which of them it is cannot be told
      if (!begun.keys.contains("when")) continue;
      const int line = at;
      const auto begins = [line](const SourceFunction& function) { return function.line == line; };
      const auto returns = [&](const SourceFunction& function) { return begins(function) && function.returns_value; };
      if (std::ranges::any_of(functions, begins) && std::ranges::none_of(functions, returns)) tell(line);
    }
  }
}

constexpr std::array<const char*, 3> always_there{"vars", "args", "*"};

class SourceCheck {
 public:
  SourceCheck(const Behavior::Parts& parts, const KnownNames& known, const LuaState::Source& source,
              std::vector<InputProblem>& problems)
      : parts_(parts), known_(known), source_(source), problems_(problems), machine_(known.machine) {
    const auto vars = known.vars.find(source.chunk);
    has_behavior_ = vars != known.vars.end();
    if (const auto own = known.machines.find(source.chunk); own != known.machines.end()) machine_ = own->second;
    if (has_behavior_) vars_ = vars->second;
  }

  void run(SourceScopes& scopes) {
    scopes.tell([this](const SourceUse& use, const Tokens&) {  // fields that the script writes itself
      const auto& path = use.meaning.path;
      if (use.assigned && use.meaning.role == SourceRole::machine && path.size() >= 2 && path[0] == "vars")
        vars_.push_back(path[1]);
    });
    std::sort(vars_.begin(), vars_.end());
    scopes.tell([this](const SourceUse& use, const Tokens& tokens) { used(use, tokens); });
    tell(value_mistakes(parts_, uses_, scopes.tokens()));
    tell(flow_mistakes(parts_.catalog, known_, has_behavior_, uses_, scopes.tokens()));
  }

 private:
  void used(const SourceUse& use, const Tokens& tokens) {
    uses_.push_back(use);
    if (!use.known) return unknown(use);
    if (use.guard) guard(use);
    if (!use.at_once.empty() && waits(use, tokens)) {
      problem(use.line,
              "a wait where '" + use.at_once + "' runs: only `run` can wait, the others are over in their tick");
    }
    switch (use.meaning.role) {
      case SourceRole::machine:
        return machine(use, tokens);
      case SourceRole::snapshot:
        if (use.assigned) return problem(place(use), "s is read-only: '" + use.meaning.path.back() + "' cannot be set");
        return fields(use, known_.snapshot, "s");
      case SourceRole::module:
        fields(use, known_.module, "kadans");
        if (use.meaning.path == std::vector<std::string>{"pose"} && use.arguments != 0) {
          tell(pose_mistakes(parts_.catalog, tokens, use.arguments));
        }
        return;
      case SourceRole::parameters:
        return parameter(use);
      case SourceRole::own_module:
        return own_module(use);
      default:
        return;
    }
  }

  const ObjectInfo* object_of(const std::string& name) const noexcept {
    const auto found = std::ranges::find(parts_.catalog.objects, name, &ObjectInfo::name);
    return found == parts_.catalog.objects.end() ? nullptr : &*found;
  }
  static int place(const SourceUse& use) { return use.lines.empty() ? use.line : use.lines.back(); }
  void problem(int line, std::string message) { problems_.push_back({source_.chunk, line, 0, std::move(message)}); }
  void tell(const Mistakes& found) {
    for (const SourceMistake& wrong : found) problem(wrong.line, wrong.message);
  }

  void unknown(const SourceUse& use) {
    const auto global = known_.globals.fields.find(use.name);
    if (global != known_.globals.fields.end()) return fields(use, global->second, use.name);  // string.format
    if (use.assigned && use.meaning.path.empty()) {
      return problem(use.line, "'" + use.name + "' would be a global: write local " + use.name);
    }
    const std::string_view foreign = foreign_name_hint(use.name);
    if (!foreign.empty()) return problem(use.line, "unknown name '" + use.name + "'" + std::string(foreign));
    const bool object = machine_.fields.contains(use.name) && object_of(use.name) != nullptr;
    const std::string here =
        object ? ": it is a field of m: m." + use.name : hint_text(use.name, known_.globals.names());
    problem(use.line, "unknown name '" + use.name + "'" + here);
  }

  // m:wait(1), motion:wait(), m.posture:move(...):wait()
  bool waits(const SourceUse& use, const Tokens& tokens) const {
    if (use.arguments == 0) return false;
    const auto& path = use.meaning.path;
    const bool machine = use.meaning.role == SourceRole::machine;
    if ((machine || use.meaning.role == SourceRole::motion) && path.empty()) return use.method == "wait";
    if (!machine || path.size() != 1 || object_of(path.front()) == nullptr) return false;
    const std::size_t after = end_of_call(tokens, use.arguments);
    return tokens[after].is(":") && tokens[after + 1].text == "wait";
  }

  // legs.bend(...), legs:bend(...)
  void own_module(const SourceUse& use) {
    const auto& path = use.meaning.path;
    const auto module = known_.modules.find(path.front());
    if (module == known_.modules.end() || module->second.open) return;
    const bool field = path.size() > 1;
    if (field && (use.assigned || use.written + 1 < path.size())) return;
    const std::string& name = field ? path[1] : use.method;
    if (name.empty() || name == "*" || module->second.fields.contains(name)) return;
    if (known_.given_somewhere.contains(name)) return;
    problem(field ? use.lines[1] : use.line,
            "module '" + path.front() + "' has no '" + name + "'" + hint_text(name, module->second.names()));
  }

  void guard(const SourceUse& use) {
    const auto& path = use.meaning.path;
    const bool of_machine = use.meaning.role == SourceRole::machine;
    const std::string dotted = path.empty() ? use.name : "m." + path.front() + (path.size() > 1 ? "." + path[1] : "");
    if (use.assigned && of_machine && !path.empty()) {
      problem(use.line, "a guard writes: '" + dotted + "' must not change while it is asked");
    } else if (use.assigned && use.outer) {
      problem(use.line, "a guard writes: '" + use.name + "' must not change while it is asked");
    } else if (of_machine && !use.method.empty() && (path.empty() || path.front() != "vars")) {
      problem(use.line, "a guard acts: '" + use.method + "' belongs into enter, during, run or action");
    }
  }

  // `m` and `s` stand in the wrong order, or the field's name is wrong.
  std::string field_hint(const std::string& name, const std::string& shown, const KnownNames::Shape& at) const {
    const bool object = shown == "s" && machine_.fields.contains(name) && object_of(name) != nullptr;
    const std::string_view foreign = object ? order_hint : foreign_field_hint(shown, name);
    return foreign.empty() ? hint_text(name, at.names()) : std::string(foreign);
  }

  // Each field on the way must be there; the ones before `written` were looked at where they were named.
  void fields(const SourceUse& use, const KnownNames::Shape& root, std::string shown) {
    const KnownNames::Shape* at = &root;
    const auto& path = use.meaning.path;
    for (std::size_t i = 0; i < path.size(); ++i) {
      if (path[i] == "*" || at->open) return;
      const auto found = at->fields.find(path[i]);
      if (found == at->fields.end()) {
        if (i + use.written >= path.size() && !at->fields.empty()) {
          problem(use.lines[i], shown + " has no '" + path[i] + "'" + field_hint(path[i], shown, *at));
        }
        return;
      }
      at = &found->second;
      shown += "." + path[i];
    }
  }

  void machine(const SourceUse& use, const Tokens& tokens) {
    const auto& path = use.meaning.path;
    if (machine_.open) return;
    if (path.empty()) {
      if (!use.method.empty() && !machine_.fields.contains(use.method)) {
        problem(use.line, "m has no '" + use.method + "'" + field_hint(use.method, "m", machine_));
      }
      if (use.method == "emit") event(tokens, use.arguments);
      return;
    }
    const ObjectInfo* object = object_of(path.front());
    if (object == nullptr || !machine_.fields.contains(path.front())) return machine_field(use, object, tokens);
    if (use.assigned) return problem(use.line, "m is read-only: '" + path.front() + "' cannot be set");
    const std::string method = path.size() > 1 ? path[1] : use.method;
    if (method.empty() || method == "*") return;
    const auto& methods = known_.object_methods;
    if (std::find(methods.begin(), methods.end(), method) == methods.end()) {
      return problem(place(use), "a control object has no '" + method + "'" + hint_text(method, methods));
    }
    if (path.size() > 1 && use.arguments != 0) {
      return problem(place(use), "call it with a colon: m." + path.front() + ":" + method + "(...)");
    }
    if (use.arguments != 0) in_sets(use, *object);
    if (use.arguments != 0) tell(argument_mistakes(parts_.catalog, *object, method, tokens, use.arguments));
  }

  // In a function of the chart, or one that such functions call, when all these states run without the object.
  void in_sets(const SourceUse& use, const ObjectInfo& object) {
    const auto& acting = use.states;
    const std::uint32_t number = object_number(parts_.catalog, object);
    const auto lacks = [&](StateIndex index) {
      const SetMask sets = parts_.chart.states[index].sets;
      return sets != 0 && (parts_.bindings.partition->objects(sets) >> number & 1U) == 0;
    };
    if (acting.empty() || !std::ranges::all_of(acting, lacks)) return;
    problem(place(use), not_in_sets(parts_.bindings, number, parts_.chart.states[*acting.begin()]).data());
  }

  // Of the behavior in this file, else of the one that is played.
  std::size_t machine_here() const {
    const auto& machines = parts_.chart.machines;
    for (std::size_t i = machines.size(); i-- > 1;) {
      if (parts_.chart.states[machines[i].root].chunk == source_.chunk) return i;
    }
    return 0;
  }

  // A plain value, or one that is counted on, in a field of vars that nobody declared.
  void undeclared(const SourceUse& use, const Tokens& tokens) {
    const std::string& name = use.meaning.path[1];
    const auto declared = known_.vars.find(source_.chunk);
    if (declared == known_.vars.end() || name == "*" || !tokens[use.next].is("=")) return;
    const std::vector<std::string>& names = declared->second;
    if (std::find(names.begin(), names.end(), name) != names.end()) return;
    const SourceToken& value = tokens[use.next + 1];
    const std::size_t own = use.next - use.at;  // m.vars.n = m.vars.n + 1
    bool itself = true;
    for (std::size_t i = 0; i < own; ++i) itself = itself && tokens[use.next + 1 + i].text == tokens[use.at + i].text;
    if (value.is_literal() || itself)
      problem(place(use), "m.vars has no '" + name + "'" + hint_text(name, names) + ": declare it in vars = { }");
  }

  // The token behind '=' of an assignment.
  static bool gives_function(const SourceUse& use, const Tokens& tokens) {
    return use.next + 1 < tokens.size() && tokens[use.next + 1].is("function");
  }

  void machine_field(const SourceUse& use, const ObjectInfo* object, const Tokens& tokens) {
    const auto& path = use.meaning.path;
    if (object != nullptr) {
      return problem(place(use), not_in_sets(parts_.bindings, path.front(), machine_here()).data());
    }
    if (use.assigned && path.front() == "vars" && path.size() > 1 && gives_function(use, tokens))
      problem(place(use), "m.vars." + path[1] + " is given a function: vars hold plain data, which a reload keeps");
    const bool free = std::find(always_there.begin(), always_there.end(), path.front()) != always_there.end();
    if (use.assigned && (!free || path.size() == 1)) {
      const std::string where =
          path.front() == "vars" ? "give its fields values: m.vars.name = 1" : "keep it in m.vars";
      return problem(place(use), "m is read-only: '" + path.front() + "' cannot be set; " + where);
    }
    if (use.assigned && path.front() == "vars" && path.size() == 2) undeclared(use, tokens);
    fields(use, machine_, "m");
    if (!has_behavior_ || path.front() != "vars" || path.size() < 2 || path[1] == "*" || use.assigned) return;
    if (std::binary_search(vars_.begin(), vars_.end(), path[1])) return;
    problem(place(use), "m.vars has no '" + path[1] + "'" + hint_text(path[1], vars_) + ": declare it in vars = { }");
  }

  void event(const Tokens& tokens, std::size_t at) {
    if (at == 0 || tokens[at].kind != TokenKind::text) return;
    if (tokens[at - 1].is("(") && !tokens[at + 1].is(")")) return;  // a part of it
    const EventId id = parts_.chart.find_event(tokens[at].text);
    if (reserved_for_reports(tokens[at].text)) {
      return problem(tokens[at].line, "'" + tokens[at].text +
                                          "' reports what happened to the behavior, it cannot be emitted: give the "
                                          "event another name");
    }
    const bool pattern = Chart::is_pattern(tokens[at].text);
    if (id != no_event && pattern)
      return problem(tokens[at].line, "'" + tokens[at].text + "' stands for several events: emit one of them");
    if (id != no_event && parts_.chart.made_by_runner(id)) {
      return problem(tokens[at].line, "'" + tokens[at].text +
                                          "' says how a state or a run ended, it cannot be emitted: give the event "
                                          "another name");
    }
    if (id != no_event || (!pattern && parts_.chart.any_pattern_takes(tokens[at].text))) return;
    problem(tokens[at].line, "nothing in this behavior waits for the event '" + tokens[at].text + "'" +
                                 hint_text(tokens[at].text, parts_.chart.events));
  }

  void parameter(const SourceUse& use) {
    const auto declared = known_.parameters.find(source_.chunk);
    if (use.meaning.path.empty() || declared == known_.parameters.end()) return;
    const std::string& name = use.meaning.path.front();
    if (use.assigned) {
      return problem(place(use), "a behavior does not set its own parameters: keep what changes in m.vars");
    }
    const auto& names = declared->second;
    if (name == "*" || std::find(names.begin(), names.end(), name) != names.end()) return;
    problem(place(use), (use.meaning.place.token == 1 ? "k.args has no '" : "k.params has no '") + name + "'" +
                            hint_text(name, names));
  }

  const Behavior::Parts& parts_;
  const KnownNames& known_;
  const LuaState::Source& source_;
  std::vector<InputProblem>& problems_;
  KnownNames::Shape machine_;
  std::vector<SourceUse> uses_;
  std::vector<std::string> vars_;
  bool has_behavior_ = false;
};

}  // namespace

void check_sources(Behavior::Parts& parts, std::vector<InputProblem>& problems) {
  KnownNames known = read_known_names(parts);
  SourceFacts facts;
  std::vector<ReadSource> read;
  for (const LuaState::Source& source : parts.lua->sources()) {
    read.push_back({&source, SourceScopes(lex_source(source.text), read.size(), facts)});
    if (!parts.chart.machines.empty()) read.back().scopes.know_functions(known.functions[source.chunk]);
  }
  name_modules(read, *parts.lua, known, facts);
  std::vector<SourceScopes*> files;
  for (ReadSource& one : read) files.push_back(&one.scopes);
  learn_facts(files, facts);
  widen_modules(read, *parts.lua, facts, known);
  for (ReadSource& one : read) SourceCheck(parts, known, *one.source, problems).run(one.scopes);
  check_module_values(read, *parts.lua, problems);
  check_guard_values(read, known, problems);
  check_events(parts.chart, parts.lua->core().events, read, problems);
}

}  // namespace kadans
