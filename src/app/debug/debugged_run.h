// The run that is debugged, in its process: counts its moments, stops where it is told to, and answers while it stands
// still.
//
// The process has one thread. It goes backwards by copies of itself (fork): now and then it leaves one behind, which
// waits until the debugger lets it repeat the run from there. Whatever is asked about the run is asked of a copy that
// is then dropped, and so are the conditions of breakpoints. So looking changes nothing: where it stops, what is looked
// at and how often it went back does not change a bit of the run.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/assembly/assembly.h"
#include "run_channel.h"
#include "scenario/judge/checks.h"
#include "scenario/run.h"
#include "script/bindings/signal_expressions.h"
#include "script/debug/inspection.h"
#include "script/lua/budget.h"

namespace kadans {

// Threads as the editor sees them: the run with its ticks, and behind it the behaviors.
inline constexpr int run_thread = 1, first_behavior_thread = 2;
// The numbers of frames and of what has fields: those of a behavior follow one another, behind those of the run.
inline constexpr int run_frame = 1, signals_number = 1, parameters_number = 2;
inline constexpr int frames_of_behavior = 1000, numbers_of_behavior = 1 << 20;

class DebuggedRun final : public RunObserver, private LineSink, private LineWatch {
 public:
  // `checks` may be nullptr. Everything must outlive it.
  DebuggedRun(RunChannel& channel, Assembly& assembly, RunLog& log, const Checks* checks);

  void begin(Json ready);  // before the first tick: tells the debugger, and waits until it lets the run go
  void end(Json result);   // after the last one: waits once more

  void tick(double time_s, std::span<const double> row) override;
  void between_ticks(const RunMark& mark) override;
  void fault(const Fault& fault) override;

 private:
  struct SignalBreak : NamedBreak {
    bool held = false;  // its condition was true
    std::size_t expression = 0;
  };
  struct Breaks {
    std::vector<LineBreak> lines;
    std::vector<NamedBreak> states;
    std::vector<SignalBreak> signals;
    std::optional<std::string> fault, transition;  // of which ones; "": of all
    bool error = false, check = false;
  };
  struct Step {
    enum class Kind : std::uint8_t { in, over, out } kind = Kind::in;
    int behavior = -1;
    bool in_run = false;
    StateIndex state = no_state;
    int depth = 0;
  };
  // How the run goes on.
  struct Goal {
    std::optional<RunPosition> until;  // stops there
    bool quiet = false;                // and nowhere before
    bool search = false;               // stops nowhere, and tells the last moment before `until` at which it would have
    bool with_end = false;             // a search takes `until` in, when that is between two ticks
    std::optional<Step> step;
  };
  struct LineCount {
    std::uint32_t hits = 0;
    bool broken = false;  // has a breakpoint
  };
  struct Chunk {
    std::string name;
    std::vector<LineCount> lines;
  };

  void line(lua_State* state, const char* chunk, int line) noexcept override;
  void raised(lua_State* state, const char* message) noexcept override;
  void tell(const Line& line) override;

  LineCount& count(const char* chunk, int line);
  bool passes(lua_State* state, int behavior);
  void look_at(lua_State* state, const char* chunk, int line, LineCount at);
  bool look_at_line(lua_State* state, const char* chunk, int line, std::uint32_t hits);
  bool step_is_over(lua_State* state) const;
  std::optional<Json> look_at_tick();
  void stop(Json why, lua_State* state = nullptr, int behavior = -1);
  void arrive(lua_State* state, int behavior);
  void serve();
  void go(const Json& order);
  void take_breaks(const Json& breaks);
  void hear_orders();
  void leave_copy();
  bool split(Json message);
  void reload();

  Json look(const Json& order);
  Json threads();
  Json frames(int thread);
  Json scopes(int frame);
  Json fields(int number);
  Json evaluate(int frame, const std::string& text);
  Json evaluate_signals(const std::string& text) const;
  std::string in_copy(const std::function<std::string()>& work);
  bool holds(const LineBreak& at, lua_State* state);
  std::string filled(const std::string& text, lua_State* state);

  void collect_behaviors();
  int behavior_of(lua_State* state) const;
  Inspection& inspection(int behavior);
  Json where() const;

  RunChannel& channel_;
  Assembly& assembly_;
  const Checks* checks_;
  std::vector<ScriptHost*> hosts_;
  std::vector<std::pair<std::string, Behavior*>> behaviors_;  // with its name among all robots'
  std::vector<Chunk> chunks_;
  std::unique_ptr<SignalExpressions> conditions_;
  Breaks breaks_;
  Goal goal_;
  Json breaks_as_told_;
  std::optional<Json> found_;  // by a search

  RunPosition now_;
  std::int64_t time_ns_ = 0;
  std::uint64_t hash_ = 0, way_ = 0;  // of the states; of the lines
  std::vector<std::uint64_t> lines_;  // that are over, by behavior, from 1 on
  std::vector<double> row_;
  std::vector<bool> lost_;  // checks
  bool paused_ = false, reloads_ = false;
  std::int64_t copied_ns_ = 0;  // processor time at the last copy

  // While it stands still:
  lua_State* state_ = nullptr;
  int behavior_ = -1;
  std::map<int, std::unique_ptr<Inspection>> inspections_;
};

}  // namespace kadans
