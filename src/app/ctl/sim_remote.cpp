#include "sim_remote.h"

#include "app/run/run_choices.h"
#include "version.h"

namespace kadans {
namespace {

constexpr std::uint32_t publish_every_ticks = 20;

}  // namespace

SimRemote::SimRemote(const ServiceOptions& places, Assembly& assembly, RecordPlan plan, BehaviorLog& log,
                     LineEcho& echo)
    : parts_(assembly.parts()),
      model_(assembly.robot().model),
      log_(log),
      instance_(facts_of(assembly, "simulation of " + assembly.scenario().name, std::filesystem::current_path()),
                assembly.catalog(), parts_.control.safety().emergency_stop()),
      control_side_(instance_),
      record_side_(instance_, control_side_, {{"robot", assembly.scenario().robot}, {"kadans", version}}),
      behavior_side_({instance_, &assembly.host(), nullptr, parts_.behaviors, parts_.control.exchange(), echo, log,
                      assembly.decision_questions()}),
      service_(places.ctl, instance_),
      live_(places.live, instance_, assembly, &pace_),
      ros2_(places.ros2, instance_, assembly, &pace_, -1) {
  pace_.check_push = [this](const std::string& text) { (void)Pushes({parse_push(text, 0)}, model_, "push"); };
  record_side_.describe_with(robot_texts(assembly));
  record_side_.record_as(std::move(plan));
  assembly.record_to(&control_side_);
}

SimRemote::~SimRemote() {
  ros2_.stop();
  live_.stop();
  service_.stop();
  (void)record_side_.stop();  // when the run threw
}

std::string SimRemote::end_record() { return record_side_.stop() ? "" : record_side_.error(); }

void SimRemote::begin(RecordSink* own, const std::string& own_file) {
  log_.add(instance_);
  if (own != nullptr) {
    record_side_.leave_to(*own, own_file);
  } else {
    log_.add(record_side_);
  }
  service_.start();
  live_.start({{"Control tick: takes", &parts_.lockstep.control_tick_cost()}});
  ros2_.start();
}

// To be called before the step that begins now.
void SimRemote::push(const RunMark& mark) {
  const double time_s = 1e-9 * static_cast<double>(mark.time_ns);
  for (const std::string& what : pace_.take_pushes()) {
    try {
      if (pushes_.size() == LivePace::pushes_max) pushes_.erase(pushes_.begin());
      pushes_.emplace_back(std::vector{parse_push(what, time_s)}, model_, "push");
      log_.message(mark.time_ns, BehaviorLog::Severity::info, "live", "push " + what + " Ns");
    } catch (const InputError& error) {
      log_.message(mark.time_ns, BehaviorLog::Severity::warning, "live", error.what());
    }
  }
  for (const Pushes& pushes : pushes_)
    pushes.apply(parts_.robot, time_s, 1e-9 * static_cast<double>(parts_.lockstep.control_period_ns()));
}

void SimRemote::between_ticks(const RunMark& mark) {
  push(mark);
  behavior_side_.beside_tick(mark.time_ns);
  if (published_++ % publish_every_ticks != 0) return;
  (void)record_side_.beat({.due_ns = mark.time_ns});
  instance_.publish(status_of(parts_.control.state(), record_side_.status()));
}

}  // namespace kadans
