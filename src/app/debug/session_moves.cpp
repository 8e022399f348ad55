// How the run goes on, and back.
#include <algorithm>
#include <stdexcept>

#include "app/terminal.h"
#include "debug_session.h"
#include "debugged_run.h"

namespace kadans {
namespace {

constexpr std::int64_t ticks_max = 1'000'000'000;

}  // namespace

Json DebugSession::go_on(const Json&) {
  need_standing();
  after_ = [this] { begin({}); };
  return {{"allThreadsContinued", true}};
}

// A step of Lua begins at this place; where none stands, at any line.
Json DebugSession::step_from_here(const char* kind, int thread) const {
  if (stop_.contains("place") && stop_.at("thread") == thread) {
    Json step = stop_.at("place");
    step["kind"] = kind;
    return step;
  }
  return {{"kind", "over"}, {"behavior", thread - first_behavior_thread}, {"depth", 1'000'000}};
}

Json DebugSession::step(const char* kind, const Json& arguments) {
  need_standing();
  const int thread = arguments.value("threadId", run_thread);
  const bool out = std::string_view(kind) == "out";
  if (thread < first_behavior_thread || arguments.value("granularity", "") == "instruction") {
    after_ = [this, out] { move_ticks(out ? "behavior" : "control", 1); };
    return {};
  }
  const Json step = step_from_here(kind, thread);
  const bool outermost = out && step.value("depth", 0) <= 1;
  after_ = [this, step, outermost] {
    if (outermost) return begin({}, RunPosition{here().tick + 1, 0});
    begin({{"step", step}});
  };
  return {};
}

Json DebugSession::step_back(const Json& arguments) {
  need_standing();
  const int thread = arguments.value("threadId", run_thread);
  if (thread < first_behavior_thread || arguments.value("granularity", "") == "instruction") {
    after_ = [this] { move_ticks("control", -1); };
    return {};
  }
  const Json step = step_from_here("over", thread);
  after_ = [this, step] { search_back(step); };
  return {};
}

Json DebugSession::reverse_continue(const Json&) {
  need_standing();
  after_ = [this] { search_back({}); };
  return {};
}

Json DebugSession::pause(const Json&) {
  const RunCopy& one = doing_ == Doing::searching ? searcher_ : current_;
  if (doing_ == Doing::running) (void)one.channel.send({{"order", "pause"}});
  if (doing_ == Doing::searching) {  // it stands where it stood before
    after_ = [this] {
      searcher_ = {};
      stop_["reason"] = "pause";
      stand(stop_);
    };
  }
  return {};
}

Json DebugSession::go_to(const Json& arguments) {
  need_standing();
  const RunPosition to{whole_number(arguments.at("tick")), whole_number(arguments.value("point", Json(0U)))};
  after_ = [this, to] {
    if (to == here()) return stand(stop_);
    if (to < here()) return arrive(to, {{"reason", "goto"}});
    reason_ = {{"reason", "goto"}};
    begin({{"quiet", true}}, to);
  };
  return {};
}

Json DebugSession::ticks(const Json& arguments) {
  need_standing();
  const std::string unit = arguments.at("unit");
  const auto count = arguments.value("count", std::int64_t{1});
  if (count > ticks_max || count < -ticks_max) throw std::runtime_error("count is too large");
  if (unit != "control" && unit != "behavior")
    throw std::runtime_error("unit is \"control\" or \"behavior\", not \"" + unit + "\"");
  after_ = [this, unit, count] { move_ticks(unit, count); };
  return {};
}

// Back, a tick that has begun counts as one.
void DebugSession::move_ticks(const std::string& unit, std::int64_t count) {
  const auto each = unit == "control" ? std::int64_t{1} : run_.at("behavior_ticks").get<std::int64_t>();
  const RunPosition at = here();
  const auto tick = static_cast<std::int64_t>(at.tick);
  const bool whole = tick % each == 0 && at.point == 0;
  const std::int64_t from = tick / each + (count < 0 && !whole ? 1 : 0);
  const RunPosition to{static_cast<std::uint64_t>(std::max<std::int64_t>(0, (from + count) * each)), 0};
  if (to > at) return begin({}, to);
  if (to < at) return arrive(to, {{"reason", "step"}});
  stand(stop_);
}

// Lets the current process go. Where the run has become another one on the way, its copy of that moment goes on.
void DebugSession::begin(Json order, std::optional<RunPosition> until) {
  if (at_end_) return end_run(stop_.value("passed", true) ? exit_passed : exit_failed);
  order_ = order.is_null() ? Json::object() : std::move(order);
  until_ = until;
  told_ = furthest_ = std::max(furthest_, here());
  looked_into_ = {};
  Json sent = order_;
  const RunCopy* const branch = reloaded_from_ ? nullptr : copies_.branch_behind(here());
  const auto limit = branch != nullptr && (!until || branch->at <= *until) ? std::optional(branch->at) : until;
  if (limit) sent["until"] = *limit;
  sent["order"] = "go";
  sent["breaks"] = breaks();
  if (!current_.channel.send(sent)) return lose_run();
  doing_ = Doing::running;
}

void DebugSession::hear_run() {
  RunCopy& speaker = doing_ == Doing::searching ? searcher_ : current_;
  RunChannel end;
  const std::optional<Json> message = speaker.channel.receive(&end);
  if (!message) return lose_run();
  const std::string what = message->value("event", "");
  if (what == "copy") {
    RunCopy copy;
    if (take_copy(*message, end, copy)) copies_.add(std::move(copy), here());
  } else if (what == "output") {
    const auto at = message->at("at").get<RunPosition>();
    if (at >= told_ || message->value("always", false))
      output(message->value("category", "console").c_str(), message->at("text"));
    furthest_ = std::max(furthest_, at);
  } else if (what == "stopped") {
    hear_stop(message->at("stop"));
  } else if (what == "found") {
    hear_found(message->at("stop"));
  } else if (what == "ended") {
    hear_end(*message);
  }
}

void DebugSession::hear_stop(const Json& stop) {
  const auto at = stop.at("at").get<RunPosition>();
  const bool arrived = stop.at("reason") == "arrived";
  const RunCopy* const branch = reloaded_from_ ? nullptr : copies_.branch_behind(here());
  if (arrived && branch != nullptr && branch->at == at && doing_ == Doing::running && until_ != at) {
    current_ = copy_of(*branch);
    stop_ = current_.where;
    return begin(order_, until_);
  }
  if (arrived && reloaded_from_) {
    branch_off(stop);
  } else if (arrived && branch != nullptr && branch->at == at) {
    current_ = copy_of(*branch);
  }
  Json shown = stop;
  if (arrived) shown.update(reason_.is_null() ? Json{{"reason", "step"}} : reason_);
  stand(std::move(shown));
}

void DebugSession::hear_end(const Json& message) {
  const auto at = message.at("stop").at("at").get<RunPosition>();
  if (!at_end_ && at >= told_) output("console", message.at("text"));
  stop_ = message.at("stop");
  stop_["passed"] = message.value("passed", false);
  at_end_ = true;
  reloaded_from_.reset();
  if (!stop_at_end_ && order_.value("quiet", false) == false && !until_)
    return end_run(message.value("passed", false) ? exit_passed : exit_failed);
  stop_["reason"] = "pause";
  stop_["text"] = "the run is over";
  stand(stop_);
}

void DebugSession::end_run(int exit_code) {
  doing_ = Doing::over;
  drop_run();
  event("exited", {{"exitCode", exit_code}});
  event("terminated");
}

void DebugSession::lose_run() {
  output("stderr", "the process of the run has ended: it crashed, or was killed\n");
  exit_code_ = exit_internal;
  end_run(exit_internal);
}

// Stands still, and tells the editor.
void DebugSession::stand(Json stop) {
  doing_ = Doing::standing;
  looked_into_ = {};
  reason_ = nullptr;
  at_end_ = stop.contains("passed");
  stop_ = std::move(stop);
  furthest_ = std::max(furthest_, here());
  Json body{{"reason", stop_.value("reason", "step")}, {"threadId", stop_.at("thread")}, {"allThreadsStopped", true}};
  if (stop_.contains("text")) body["description"] = body["text"] = stop_.at("text");
  if (stop_.contains("ids")) body["hitBreakpointIds"] = stop_.at("ids");
  event("stopped", std::move(body));
}

// To the last moment before this one at which a breakpoint would have stopped the run, or a step would have ended.
void DebugSession::search_back(std::optional<Json> step) {
  search_step_ = std::move(step);
  const std::size_t copy = copies_.last_before(here(), false);
  if (copy == copies_.size()) {
    stop_["reason"] = "entry";
    return stand(stop_);
  }
  search_in(copy, here(), stop_, false);
}

namespace {

// How many lines of this behavior were over.
std::uint64_t lines_at(const Json& where, int behavior) {
  const Json& all = where.at("lines");
  const auto index = static_cast<std::size_t>(behavior + 1);
  return index < all.size() ? all[index].get<std::uint64_t>() : 0;
}

}  // namespace

// In the stretch between this copy and `until`, which is at `where`. A step back never ends in one without lines of its
// behavior.
void DebugSession::search_in(std::size_t copy, RunPosition until, const Json& where, bool with_end) {
  const int behavior = search_step_ ? search_step_->value("behavior", -1) : -1;
  while (search_step_ && lines_at(copies_[copy].where, behavior) == lines_at(where, behavior)) {
    until = copies_[copy].at;
    with_end = true;
    if (copy == 0) return arrive(until, {{"reason", "entry"}});
    --copy;
  }
  searcher_ = copy_of(copies_[copy]);
  Json order{{"order", "go"}, {"search", true}, {"until", until}, {"with_end", with_end}, {"breaks", breaks()}};
  if (search_step_) {
    order["step"] = *search_step_;
    order["breaks"] = {
        {"lines", Json::array()}, {"states", Json::array()}, {"signals", Json::array()}, {"filters", Json::array()}};
  }
  doing_ = Doing::searching;
  if (!searcher_.channel.send(order)) lose_run();
}

void DebugSession::hear_found(const Json& stop) {
  const RunPosition searched_from = searcher_.at;
  const Json where = searcher_.where;
  searcher_ = {};
  if (!stop.is_null()) {
    Json reason{{"reason", stop.at("reason")}, {"thread", stop.at("thread")}};
    for (const char* field : {"ids", "text", "filter"}) {
      if (stop.contains(field)) reason[field] = stop.at(field);
    }
    return arrive(stop.at("at").get<RunPosition>(), std::move(reason));
  }
  const std::size_t before = copies_.last_before(searched_from, false);
  if (before == copies_.size()) return arrive(searched_from, {{"reason", "entry"}});
  search_in(before, searched_from, where, true);
}

// Goes back to this moment.
void DebugSession::arrive(const RunPosition& at, Json reason) {
  const std::size_t copy = copies_.last_before(at, true);
  current_ = copy_of(copies_[std::min(copy, copies_.size() - 1)]);
  reason_ = std::move(reason);
  told_ = furthest_ = std::max(furthest_, here());
  at_end_ = false;
  looked_into_ = {};
  if (current_.at == at) {
    Json stop = current_.where;
    stop.update(reason_);
    return stand(std::move(stop));
  }
  order_ = {{"quiet", true}};
  until_ = at;
  doing_ = Doing::arriving;
  if (!current_.channel.send({{"order", "go"}, {"quiet", true}, {"until", at}, {"breaks", breaks()}})) lose_run();
}

// The behaviors are read again in their next tick. Behind it the run is another one: the copy that is left there has
// read the files, so it is the same however often it is gone through.
Json DebugSession::reload(const Json&) {
  need_standing();
  if (at_end_) throw std::runtime_error("the run is over");
  after_ = [this] {
    const std::uint64_t each = run_.at("behavior_ticks"), from = here().tick + (here().point > 0 ? 1 : 0);
    reloaded_from_ = here();
    begin({{"quiet", true}, {"reload", true}}, RunPosition{(from + each - 1) / each * each + 1, 0});
    told_ = here();
  };
  return {};
}

// After the behaviors were read again.
void DebugSession::branch_off(const Json& stop) {
  copies_.drop_behind(*reloaded_from_);
  reloaded_from_.reset();
  RunCopy copy = copy_of(current_);
  copy.branch = true;
  furthest_ = copy.at;
  output("console", "branch " + std::to_string(++branches_) + " in tick " + std::to_string(copy.at.tick) +
                        ": the behaviors were read again; what came later is forgotten\n");
  copies_.add(std::move(copy), stop.at("at").get<RunPosition>());
}

}  // namespace kadans
