#include "debug_session.h"

#include <algorithm>
#include <array>
#include <stdexcept>

#include <poll.h>

#include "app/terminal.h"
#include "debugged_run.h"
#include "kadans/signal/nearest_name.h"
#include "realtime/machine/child_process.h"
#include "signal/number_text.h"

namespace kadans {
namespace {

[[noreturn]] void refuse_it(const std::string& why) { throw std::runtime_error(why); }

}  // namespace

std::uint64_t whole_number(const Json& json) {
  const bool whole = json.is_number_unsigned() || (json.is_number_integer() && json.get<std::int64_t>() >= 0);
  if (!whole) refuse_it("a number is not whole, or below 0");
  return json.get<std::uint64_t>();
}

namespace {

constexpr std::array<std::string_view, 7> own_questions{"evaluate",  "threads",       "stackTrace",        "scopes",
                                                        "variables", "exceptionInfo", "dataBreakpointInfo"};

constexpr const char* orders_help =
    ":control [N]    N control ticks on, or back when N is below 0\n"
    ":behavior [N]   the same for behavior ticks\n"
    ":tick N         to this control tick\n"
    ":reload         reads the behaviors again, in their next tick, and goes on with them: a branch\n"
    ":where          the tick, the moment in it, and the hash of all states until then\n"
    "Other lines are Lua, evaluated in a copy of the run; in the frame of a tick they are signals";

}  // namespace

DebugSession::DebugSession(const DebugOptions& options, DapStream stream)
    : options_(options), stream_(std::move(stream)), copies_(options.memory_MB) {}

int DebugSession::run() {
  try {
    while (!left_) {
      const RunCopy& heard = doing_ == Doing::searching ? searcher_ : current_;
      std::array<pollfd, 2> ends{{{stream_.input(), POLLIN, 0}, {heard.channel.socket(), POLLIN, 0}}};
      if (poll(ends.data(), ends.size(), -1) < 0) continue;
      if (ends[1].revents != 0) hear_run();
      if (ends[0].revents == 0) continue;
      if (!stream_.read()) break;
      while (const std::optional<Json> request = stream_.next()) handle(*request);
    }
  } catch (const InputError& error) {
    print_problems(error);
    return exit_failed;
  }
  return exit_code_;
}

void DebugSession::handle(const Json& request) {
  if (request.value("type", Json()) != "request" || !request.value("command", Json()).is_string() ||
      !request.value("seq", Json()).is_number_integer())
    return;  // an answer, to nothing that was asked
  const std::string command = request.at("command");
  Json response{{"type", "response"}, {"request_seq", request.at("seq")}, {"command", command}, {"success", true}};
  after_ = nullptr;
  try {
    const Json arguments = request.value("arguments", Json::object());
    Json body = answer(command, arguments.is_object() ? arguments : Json::object());
    if (!body.empty()) response["body"] = std::move(body);
  } catch (const std::exception& error) {
    const auto* json = dynamic_cast<const Json::exception*>(&error);
    const std::string why = json != nullptr ? "an argument is missing or of another kind" : error.what();
    response["success"] = false;
    response["message"] = why;
    // What a person asked for. An editor asks the rest itself, for each watch after each step, and shows it in place.
    const bool show = std::ranges::find(own_questions, command) == own_questions.end();
    response["body"] = {{"error", {{"id", 1}, {"format", "{why}"}, {"variables", {{"why", why}}}, {"showUser", show}}}};
  }
  stream_.send(std::move(response));
  // Editors know that `continue` and steps let the run go, but not that an evaluated line does.
  if (after_ && (command == "evaluate" || command.starts_with("kadans/")))
    event("continued", {{"threadId", stop_.at("thread")}, {"allThreadsContinued", true}});
  try {
    if (const auto begin = std::exchange(after_, nullptr)) begin();
  } catch (const std::exception& error) {
    output("stderr", std::string(error.what()) + "\n");
    if (doing_ == Doing::standing) stand(stop_);
  }
}

Json DebugSession::answer(const std::string& command, const Json& arguments) {
  static const std::map<std::string, Handler> handlers{
      {"initialize", &DebugSession::initialize},
      {"launch", &DebugSession::launch},
      {"attach", &DebugSession::launch},
      {"configurationDone", &DebugSession::configuration_done},
      {"setBreakpoints", &DebugSession::set_breakpoints},
      {"setFunctionBreakpoints", &DebugSession::set_function_breakpoints},
      {"setExceptionBreakpoints", &DebugSession::set_exception_breakpoints},
      {"dataBreakpointInfo", &DebugSession::data_breakpoint_info},
      {"setDataBreakpoints", &DebugSession::set_data_breakpoints},
      {"threads", &DebugSession::threads},
      {"stackTrace", &DebugSession::stack_trace},
      {"scopes", &DebugSession::scopes},
      {"variables", &DebugSession::variables},
      {"evaluate", &DebugSession::evaluate},
      {"loadedSources", &DebugSession::loaded_sources},
      {"exceptionInfo", &DebugSession::exception_info},
      {"continue", &DebugSession::go_on},
      {"next", &DebugSession::next},
      {"stepIn", &DebugSession::step_in},
      {"stepOut", &DebugSession::step_out},
      {"stepBack", &DebugSession::step_back},
      {"reverseContinue", &DebugSession::reverse_continue},
      {"pause", &DebugSession::pause},
      {"terminate", &DebugSession::terminate},
      {"disconnect", &DebugSession::leave},
      {"kadans/position", &DebugSession::position},
      {"kadans/goto", &DebugSession::go_to},
      {"kadans/ticks", &DebugSession::ticks},
      {"kadans/reload", &DebugSession::reload},
  };
  const auto handler = handlers.find(command);
  if (handler == handlers.end()) refuse_it("kadans does not know the request '" + command + "'");
  Json body = (this->*handler->second)(arguments);
  if (command == "disconnect") left_ = true;
  return body;
}

void DebugSession::event(const char* name, Json body) {
  stream_.send({{"type", "event"}, {"event", name}, {"body", std::move(body)}});
}

void DebugSession::output(const char* category, const std::string& text) {
  event("output", {{"category", category}, {"output", text}});
}

Json DebugSession::initialize(const Json& arguments) {
  if (!arguments.value("linesStartAt1", true) || !arguments.value("columnsStartAt1", true) ||
      arguments.value("pathFormat", "path") != "path")
    refuse_it("kadans counts lines and columns from 1, and names files by their paths");
  const auto filter = [](const char* name, const char* label, const char* doc, bool on, const char* condition) {
    Json one{{"filter", name}, {"label", label}, {"description", doc}, {"default", on}};
    if (condition != nullptr) one.update({{"supportsCondition", true}, {"conditionDescription", condition}});
    return one;
  };
  return {{"supportsConfigurationDoneRequest", true},
          {"supportsFunctionBreakpoints", true},
          {"supportsConditionalBreakpoints", true},
          {"supportsHitConditionalBreakpoints", true},
          {"supportsLogPoints", true},
          {"supportsEvaluateForHovers", true},
          {"supportsStepBack", true},
          {"supportsSteppingGranularity", true},
          {"supportsDataBreakpoints", true},
          {"supportsExceptionFilterOptions", true},
          {"supportsExceptionInfoRequest", true},
          {"supportsLoadedSourcesRequest", true},
          {"supportsTerminateRequest", true},
          {"supportsDelayedStackTraceLoading", true},
          {"supportsSetVariable", false},  // what is shown is a copy
          {"exceptionBreakpointFilters",
           {filter("error", "Errors of scripts", "A behavior raises an error that it does not catch", true, nullptr),
            filter("fault", "Faults", "The safety layer finds a fault", false, "part of its text: motor_hot of l_knee"),
            filter("check", "Failed checks", "A check of the scenario can no longer pass", true, nullptr),
            filter("transition", "Transitions", "A behavior goes into another state", false,
                   "FROM -> TO, or TO: states by their last names; * for any")}}};
}

Json DebugSession::launch(const Json& arguments) {
  if (doing_ != Doing::nothing) refuse_it("the run is there already");
  DebugLaunch launch;
  RunChoices& choices = launch.choices;
  launch.file = arguments.value("program", options_.file);
  choices.play = arguments.value("play", "");
  choices.set = arguments.value("set", std::vector<std::string>());
  launch.from_record = arguments.value("fromRecord", options_.from_record);
  launch.allow_plugins = options_.allow_plugins;
  if (arguments.contains("seed")) choices.seed = whole_number(arguments.at("seed"));
  if (arguments.contains("duration")) choices.duration_s = arguments.at("duration").get<double>();
  if (choices.duration_s && !(*choices.duration_s > 0 && *choices.duration_s <= scenario_duration_max_s))
    refuse_it("duration must be a number of seconds above 0");
  if (options_.port && launch.file != options_.file)
    refuse_it("at a port, the command line says what runs: " + options_.file);
  if (launch.file.empty()) refuse_it("name a scenario or a record, as \"program\" or on the command line");
  stop_on_entry_ = arguments.value("stopOnEntry", false);
  stop_at_end_ = arguments.value("stopAtEnd", false);
  subject_.emplace(debug_subject(std::move(launch)));

  auto [ours, theirs] = RunChannel::make_pair();
  const pid_t pid = ChildProcess::copy_alone();
  if (pid < 0) refuse_it("the system makes no process for the run");
  if (pid == 0) {
    ours.close();
    debug_in_this_process(std::move(theirs), *subject_);
  }
  theirs.close();
  const std::optional<Json> told = ours.receive();
  if (!told) refuse_it("the process of the run ended before it was ready");
  if (told->value("event", "") != "ready") refuse_it(told->value("text", "the run is not ready"));
  run_ = *told;
  for (const Json& source : run_.at("sources")) paths_[source.at("chunk")] = source.at("path");
  stop_ = run_.at("where");
  current_ = {std::move(ours), pid, here(), stop_, false};
  copies_.add(copy_of(current_), here());
  doing_ = Doing::standing;
  after_ = [this] { event("initialized"); };
  return {};
}

Json DebugSession::configuration_done(const Json&) {
  need_standing();
  after_ = [this] {
    if (!stop_on_entry_) return begin({});
    stop_["reason"] = "entry";
    stand(stop_);
  };
  return {};
}

void DebugSession::need_run() const {
  if (doing_ == Doing::nothing) refuse_it("there is no run yet: launch comes first");
}

void DebugSession::need_standing() const {
  need_run();
  if (doing_ == Doing::over) refuse_it("the run is over");
  if (doing_ != Doing::standing) refuse_it("notStopped");
}

Json DebugSession::threads(const Json&) {
  if (doing_ == Doing::standing) return look({{"what", "threads"}});
  return {{"threads", {{{"id", run_thread}, {"name", "run"}}}}};
}

Json DebugSession::stack_trace(const Json& arguments) {
  const Json answer = look({{"what", "frames"}, {"thread", arguments.at("threadId")}});
  const Json& all = answer.at("frames");
  const auto from = arguments.value("startFrame", std::size_t{0}), levels = arguments.value("levels", std::size_t{0});
  Json shown = Json::array();
  for (std::size_t i = from; i < all.size() && (levels == 0 || i - from < levels); ++i) {
    Json frame{{"id", all[i].at("id")}, {"name", all[i].at("name")}, {"line", all[i].at("line")}, {"column", 1}};
    if (all[i].contains("chunk")) frame["source"] = source_of(all[i].at("chunk"));
    if (!all[i].contains("chunk") && !subject_->recorded) {  // a record is no text
      frame["line"] = 1;
      frame["source"] = {{"name", "run"}, {"path", run_.at("file")}};
    }
    if (all[i].value("of_chart", false)) frame["presentationHint"] = "subtle";
    shown.push_back(std::move(frame));
  }
  return {{"stackFrames", std::move(shown)}, {"totalFrames", all.size()}};
}

Json DebugSession::scopes(const Json& arguments) {
  return look({{"what", "scopes"}, {"frame", arguments.at("frameId")}});
}

Json DebugSession::variables(const Json& arguments) {
  Json answer = look({{"what", "fields"}, {"number", arguments.at("variablesReference")}});
  Json& all = answer["variables"];
  const auto from = std::min(arguments.value("start", std::size_t{0}), all.size());
  const auto count = arguments.value("count", std::size_t{0});
  const auto first = all.begin() + static_cast<std::ptrdiff_t>(from);
  const auto end = count == 0 || count > all.size() - from ? all.end() : first + static_cast<std::ptrdiff_t>(count);
  return {{"variables", std::vector<Json>(first, end)}};
}

Json DebugSession::evaluate(const Json& arguments) {
  const std::string text = arguments.at("expression");
  const std::string context = arguments.value("context", "");
  if (context == "repl" && text.starts_with(':')) return {{"result", order(text)}, {"variablesReference", 0}};
  Json value = look({{"what", "evaluate"}, {"frame", arguments.value("frameId", 0)}, {"text", text}});
  return {{"result", value.at("value")},
          {"type", value.at("type")},
          {"variablesReference", value.at("variablesReference")}};
}

std::string DebugSession::order(const std::string& text) {
  const std::size_t blank = std::min(text.find(' '), text.size());
  const std::string word = text.substr(1, blank - 1);
  const std::size_t begin = std::min(text.find_first_not_of(' ', blank), text.size());
  const std::string rest = text.substr(begin, text.find_last_not_of(' ') + 1 - begin);
  const std::optional<std::int64_t> number =
      rest.empty() ? std::optional<std::int64_t>(1) : number_of<std::int64_t>(rest);
  if (word == "help") return orders_help;
  need_standing();
  const RunPosition at = here();
  if (word == "where")
    return "tick " + std::to_string(at.tick) + ", moment " + std::to_string(at.point) +
           printed(", %.3f s, ", stop_.at("time_s").get<double>()) + stop_.at("state_hash").get<std::string>();
  if (word == "reload") {
    (void)reload(Json::object());
    return "";
  }
  const std::vector<std::string> words{"control", "behavior", "tick", "reload", "where", "help"};
  if (std::ranges::find(words, word) == words.end())
    refuse_it("unknown order ':" + word + "'" + did_you_mean(word, words) + " (:help lists them)");
  if (!number || (word == "tick" && (rest.empty() || *number < 0)))
    refuse_it("':" + word + "' wants a number of ticks: :" + word + " 10");
  if (word == "tick") {
    (void)go_to({{"tick", *number}});
  } else {
    (void)ticks({{"unit", word}, {"count", *number}});
  }
  return "";
}

Json DebugSession::loaded_sources(const Json&) {
  Json all = Json::array();
  for (const auto& [chunk, path] : paths_) all.push_back(source_of(chunk));
  return {{"sources", all}};
}

Json DebugSession::source_of(const std::string& chunk) const {
  const auto path = paths_.find(chunk);
  return {{"name", chunk},
          {"path", path == paths_.end() ? run_.at("root").get<std::string>() + "/" + chunk : path->second}};
}

// Asks a copy, which may change while it answers, and may take too long.
Json DebugSession::look(Json order) {
  need_standing();
  if (!looked_into_.there()) looked_into_ = copy_of(current_);
  order["order"] = "look";
  const std::optional<Json> answer = looked_into_.channel.send(order) ? looked_into_.channel.receive() : std::nullopt;
  if (!answer) {
    looked_into_ = {};
    refuse_it("this takes longer than 2 s");
  }
  if (answer->contains("error")) refuse_it(answer->at("error"));
  return *answer;
}

Json DebugSession::position(const Json&) {
  need_standing();
  return stop_;
}

void DebugSession::drop_run() {
  current_ = {};
  searcher_ = {};
  looked_into_ = {};
  copies_.clear();
}

Json DebugSession::exception_info(const Json&) {
  need_standing();
  if (stop_.value("reason", "") != "exception")
    refuse_it("the run does not stand at an error, fault, check or transition");
  return {{"exceptionId", stop_.at("filter")}, {"description", stop_.at("text")}, {"breakMode", "always"}};
}

Json DebugSession::terminate(const Json& arguments) {
  // Only once: Emacs answers the event with this request.
  if (doing_ != Doing::over) after_ = [this] { event("terminated"); };
  return leave(arguments);
}

Json DebugSession::leave(const Json&) {
  drop_run();
  doing_ = Doing::over;
  return {};
}

}  // namespace kadans
