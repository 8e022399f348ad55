// Where the run stops, as the editor sets it.
#include <algorithm>
#include <filesystem>

#include "debug_session.h"
#include "debugged_run.h"
#include "kadans/signal/input_error.h"
#include "script/debug/code_lines.h"
#include "signal/input_file.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t script_bytes_max = std::size_t{1} << 20U;

CodeLines code_lines_of(const std::string& path) {
  try {
    return code_lines(read_input_file(path, script_bytes_max));
  } catch (const InputError& error) {
    return {.error = error.problems().front().message, .lines = {}, .functions = {}};
  }
}

Json unverified(int id, const std::string& why) { return {{"id", id}, {"verified", false}, {"message", why}}; }

// A state by its last names; `all` are "behavior.path".
bool names_state(const std::string& text, const Json& all) {
  return std::ranges::any_of(all, [&](const Json& one) {
    const std::string state = one;
    return !text.empty() && (state == text || state.ends_with("." + text));
  });
}

}  // namespace

// The chunk of a file: that of a behavior of this run, else as it would be called in the project. "": of neither.
std::string DebugSession::chunk_of(const std::string& path) const {
  std::error_code ignored;
  const fs::path wanted = fs::weakly_canonical(path, ignored);
  for (const auto& [chunk, known] : paths_) {
    if (fs::weakly_canonical(known, ignored) == wanted || path.ends_with("/" + chunk)) return chunk;
  }
  const std::string below = wanted.lexically_relative(run_.at("root").get<std::string>()).generic_string();
  return below.starts_with("..") ? "" : below;
}

Json DebugSession::set_breakpoints(const Json& arguments) {
  need_run();
  const std::string path = arguments.at("source").value("path", "");
  const std::string chunk = chunk_of(path);
  const bool read = paths_.contains(chunk);
  const CodeLines code = chunk.empty() ? CodeLines() : code_lines_of(path);
  std::vector<LineBreak> wishes;
  Json answers = Json::array();
  for (const Json& one : arguments.value("breakpoints", Json::array())) {
    const int id = ++last_id_, wanted = one.at("line");
    const int line = code.line_from(wanted);
    if (chunk.empty() || line == 0) {
      answers.push_back(unverified(id, chunk.empty()         ? "the file is not in the project of this run"
                                       : !code.error.empty() ? code.error
                                                             : "there is no code from this line on"));
      continue;
    }
    wishes.push_back(
        {id, chunk, line, one.value("condition", ""), one.value("hitCondition", ""), one.value("logMessage", "")});
    Json answer{{"id", id}, {"verified", read}, {"line", line}};
    if (!read) answer["message"] = "no behavior of this run reads this file so far";
    answers.push_back(std::move(answer));
  }
  lines_[path] = std::move(wishes);
  tell_breaks();
  return {{"breakpoints", answers}};
}

// A function of Lua, a state, or a condition on signals.
Json DebugSession::set_function_breakpoints(const Json& arguments) {
  need_run();
  functions_.clear(), states_.clear(), conditions_.clear();
  Json answers = Json::array();
  for (const Json& one : arguments.at("breakpoints")) {
    const std::string name = one.at("name"), condition = one.value("condition", ""),
                      hits = one.value("hitCondition", "");
    const int id = ++last_id_;
    const std::size_t before = functions_.size();
    for (const auto& [chunk, path] : paths_) {
      for (const CodeLines::Function& function : code_lines_of(path).functions) {
        if (function.name == name && function.code > 0)
          functions_.push_back({id, chunk, function.code, condition, hits, ""});
      }
    }
    if (functions_.size() > before) {
      answers.push_back({{"id", id}, {"verified", true}, {"line", functions_.back().line}});
      answers.back()["source"] = source_of(functions_.back().chunk);
    } else if (names_state(name, run_.at("states"))) {
      states_.push_back({id, name});
      answers.push_back({{"id", id}, {"verified", true}, {"message", "when this state is entered"}});
    } else if (const std::string wrong = wrong_condition(name); wrong.empty()) {
      conditions_.push_back({id, name});
      answers.push_back({{"id", id}, {"verified", true}, {"message", "when this becomes true"}});
    } else {
      answers.push_back(unverified(id, "is no function or state of these behaviors, and no condition: " + wrong));
    }
  }
  tell_breaks();
  return {{"breakpoints", answers}};
}

Json DebugSession::set_exception_breakpoints(const Json& arguments) {
  filters_ = Json::array();
  for (const Json& filter : arguments.value("filters", Json::array())) filters_.push_back({{"name", filter}});
  for (const Json& filter : arguments.value("filterOptions", Json::array()))
    filters_.push_back({{"name", filter.at("filterId")}, {"condition", filter.value("condition", "")}});
  if (doing_ != Doing::nothing) tell_breaks();
  return {};
}

Json DebugSession::data_breakpoint_info(const Json& arguments) {
  const std::string name = arguments.at("name");
  const int of = arguments.value("variablesReference", signals_number);
  if (of != signals_number && of != 0) return {{"dataId", nullptr}, {"description", "only signals can be watched"}};
  if (const std::string wrong = wrong_condition(name + " == 0"); !wrong.empty())
    return {{"dataId", nullptr}, {"description", wrong}};
  return {{"dataId", name}, {"description", name}, {"accessTypes", {"write"}}};
}

// "> 0.3", "joint.l_knee.position_rad > 0.3", or nothing: it changes.
Json DebugSession::set_data_breakpoints(const Json& arguments) {
  need_run();
  data_.clear();
  Json answers = Json::array();
  for (const Json& one : arguments.at("breakpoints")) {
    const int id = ++last_id_;
    const std::string name = one.at("dataId"), condition = one.value("condition", "");
    const bool operation = condition.find_first_of("<>=~") == 0;
    const std::string text = condition.empty() ? name + " ~= last." + name
                             : operation       ? name + " " + condition
                                               : condition;
    if (const std::string wrong = wrong_condition(text); !wrong.empty()) {
      answers.push_back(unverified(id, wrong));
      continue;
    }
    data_.push_back({id, text});
    answers.push_back({{"id", id}, {"verified", true}});
  }
  tell_breaks();
  return {{"breakpoints", answers}};
}

// What is wrong with a condition on signals; "": nothing.
std::string DebugSession::wrong_condition(const std::string& text) {
  if (doing_ != Doing::standing) return "while the run goes on, nobody can tell; pause it first";
  try {
    const Json value = look({{"what", "evaluate"}, {"frame", run_frame}, {"text", text}});
    return value.value("type", "") == "boolean" ? "" : "it is a number, no condition";
  } catch (const std::runtime_error& error) {
    return error.what();
  }
}

Json DebugSession::breaks() const {
  std::vector<LineBreak> lines;
  for (const auto& [path, wishes] : lines_) lines.insert(lines.end(), wishes.begin(), wishes.end());
  lines.insert(lines.end(), functions_.begin(), functions_.end());
  std::vector<NamedBreak> signals = conditions_;
  signals.insert(signals.end(), data_.begin(), data_.end());
  return {{"lines", lines}, {"states", states_}, {"signals", signals}, {"filters", filters_}};
}

// To a run that goes on; one that stands still hears them when it is let go.
void DebugSession::tell_breaks() {
  if (doing_ == Doing::running) (void)current_.channel.send({{"order", "breaks"}, {"breaks", breaks()}});
}

}  // namespace kadans
