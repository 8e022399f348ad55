// The debugger between an editor, which speaks the Debug Adapter Protocol, and the processes of the run.
//
// One process of the run goes on or stands still where the editor shows it. Copies wait at earlier moments. To go back
// to a moment, a copy of the last copy before it repeats the run up to there. To go back to the last moment that has a
// property (a breakpoint, the line before), a copy repeats the run and tells the last such moment; when there is none,
// the copy before it does the same, and so on.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "app/commands.h"
#include "dap_stream.h"
#include "debugged_process.h"
#include "run_copies.h"

namespace kadans {

// `kadans debug`: serves the Debug Adapter Protocol for a simulation or the repetition of a record (docs/debugging.md).
struct DebugOptions {
  std::string file;         // scenario or record; "": the client names it
  std::optional<int> port;  // of this machine, for one client; nullopt: stdin and stdout
  double memory_MB = 1024;  // of all processes of the run
  bool from_record = false, allow_plugins = false;
};

std::uint64_t whole_number(const Json& json);  // throws std::runtime_error

class DebugSession {
 public:
  DebugSession(const DebugOptions& options, DapStream stream);

  // Until the editor leaves. Returns the program's exit code.
  int run();

 private:
  enum class Doing : std::uint8_t { nothing, standing, running, searching, arriving, over };
  using Handler = Json (DebugSession::*)(const Json&);

  void handle(const Json& request);
  Json answer(const std::string& command, const Json& arguments);
  void event(const char* name, Json body = Json::object());
  void output(const char* category, const std::string& text);

  Json initialize(const Json& arguments);
  Json launch(const Json& arguments);
  Json configuration_done(const Json&);
  Json set_breakpoints(const Json& arguments);
  Json set_function_breakpoints(const Json& arguments);
  Json set_exception_breakpoints(const Json& arguments);
  Json data_breakpoint_info(const Json& arguments);
  Json set_data_breakpoints(const Json& arguments);
  Json threads(const Json&);
  Json stack_trace(const Json& arguments);
  Json scopes(const Json& arguments);
  Json variables(const Json& arguments);
  Json evaluate(const Json& arguments);
  Json loaded_sources(const Json&);
  Json exception_info(const Json&);
  Json go_on(const Json&);
  Json next(const Json& arguments) { return step("over", arguments); }
  Json step_in(const Json& arguments) { return step("in", arguments); }
  Json step_out(const Json& arguments) { return step("out", arguments); }
  Json step_back(const Json& arguments);
  Json reverse_continue(const Json&);
  Json pause(const Json&);
  Json terminate(const Json&);
  Json leave(const Json&);
  Json position(const Json&);
  Json go_to(const Json& arguments);
  Json ticks(const Json& arguments);
  Json reload(const Json&);

  Json step(const char* kind, const Json& arguments);
  Json step_from_here(const char* kind, int thread) const;
  std::string order(const std::string& text);  // one that begins with a colon
  void move_ticks(const std::string& unit, std::int64_t count);

  void hear_run();
  void hear_stop(const Json& stop);
  void hear_found(const Json& stop);
  void hear_end(const Json& message);
  void lose_run();
  void drop_run();
  void branch_off(const Json& stop);
  void begin(Json order, std::optional<RunPosition> until = {});
  void search_back(std::optional<Json> step);
  void search_in(std::size_t copy, RunPosition until, const Json& where, bool with_end);
  void arrive(const RunPosition& at, Json reason);
  void stand(Json stop);
  void end_run(int exit_code);
  Json look(Json order);
  Json breaks() const;
  void tell_breaks();
  std::string wrong_condition(const std::string& text);
  void need_run() const;
  void need_standing() const;
  RunPosition here() const { return stop_.at("at").get<RunPosition>(); }
  std::string chunk_of(const std::string& path) const;
  Json source_of(const std::string& chunk) const;

  const DebugOptions& options_;
  DapStream stream_;
  Doing doing_ = Doing::nothing;
  std::function<void()> after_;  // what an answered request begins
  bool left_ = false;
  int exit_code_ = 0;

  std::optional<DebugSubject> subject_;
  bool stop_on_entry_ = false, stop_at_end_ = false;
  Json run_;                                  // what it told when it was ready
  std::map<std::string, std::string> paths_;  // of chunks

  RunCopies copies_;
  RunCopy current_;      // where the editor is
  RunCopy searcher_;     // while it searches
  RunCopy looked_into_;  // a copy of the current one
  Json stop_;            // where the current one stands
  Json order_;           // how it was let go
  std::optional<RunPosition> until_;
  std::optional<Json> search_step_;
  Json reason_;  // with which it will stand
  bool at_end_ = false;
  RunPosition furthest_, told_;               // ever; what was said up to there was said before
  std::optional<RunPosition> reloaded_from_;  // while the run goes to where it becomes another one
  int branches_ = 0;

  int last_id_ = 0;
  std::map<std::string, std::vector<LineBreak>> lines_;  // by path
  std::vector<LineBreak> functions_;
  std::vector<NamedBreak> states_, conditions_, data_;
  Json filters_ = Json::array();
};

}  // namespace kadans
