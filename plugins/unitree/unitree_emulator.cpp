#include "unitree_emulator.h"

#include <algorithm>
#include <utility>

namespace unitree {
namespace {

constexpr std::int64_t session_over_ns = 1'000'000'000, in_step_timeout_ns = 60'000'000'000;
constexpr std::int64_t look_ns = 5'000'000;
constexpr std::int32_t commands_kept = 32;
constexpr std::uint32_t in_step_ahead_max = 10;  // commands in a beat; beyond that they are lost

}  // namespace

UnitreeEmulator::UnitreeEmulator(const Settings& settings, const kadans::PlantSite& site)
    : place_(settings.place()),
      period_ns_(site.layout.period_ns),
      divisor_(static_cast<std::uint32_t>(std::max<std::int64_t>(1, settings.period_ns() / site.layout.period_ns))),
      robot_(settings, site),
      domain_(settings),
      commands_(domain_.reader(command_type(robot_.family()), command_topic, DdsDomain::Own::heard, commands_kept)),
      states_(domain_.writer(state_type(robot_.family()), state_topic)),
      second_(0) {}

bool UnitreeEmulator::await(int milliseconds) noexcept {
  for (std::int64_t left_ns = std::int64_t{milliseconds} * 1'000'000; left_ns > 0; left_ns -= look_ns) {
    if (readers_of(states_) + writers_of(commands_) > 0) {
      session_ = {};
      time_runs_ = driven_ = damped_ = false;
      time_ns_ = silent_ns_ = 0;
      heard_ = told_ = 0;
      while (take_packet(commands_, command_words(robot_.family()), packet_)) {
      }
      return true;
    }
    dds_sleepfor(look_ns);
  }
  return false;
}

void UnitreeEmulator::hear_all() noexcept {
  for (std::int32_t i = 0; i < commands_kept; ++i) {
    if (!take_packet(commands_, command_words(robot_.family()), packet_)) return;
    if (!robot_.hear(packet_)) continue;
    ++heard_;
    driven_ = true;
    silent_ns_ = 0;
  }
}

// What the fault "second_writer" writes.
void UnitreeEmulator::write_beside() noexcept {
  try {
    if (robot_.second_writer() && second_ <= 0) second_ = domain_.writer(command_type(robot_.family()), command_topic);
  } catch (const std::exception&) {
    return;
  }
  if (!robot_.second_writer() && second_ > 0) (void)dds_delete(std::exchange(second_, 0));
  if (second_ <= 0) return;
  robot_.second_command(packet_);
  (void)dds_write(second_, packet_.words.data());
}

// How many periods pass for the model.
std::uint32_t UnitreeEmulator::due(std::uint32_t periods) noexcept {
  const std::uint32_t heard = std::exchange(heard_, 0);
  return in_step_ && time_runs_ ? divisor_ * std::min(heard, in_step_ahead_max) : periods;
}

bool UnitreeEmulator::beat(kadans::World& world, std::uint32_t periods) {
  kadans::WorldRobot& model = world.robot(0);
  if (time_runs_) faults_.happen(robot_, time_ns_);
  write_beside();
  hear_all();
  time_runs_ = time_runs_ || robot_.any_torque();
  const std::uint32_t due = this->due(periods);
  for (std::uint32_t i = 0; i < due; ++i) {
    robot_.pass(period_ns_);
    if (!time_runs_) continue;
    robot_.drive(model);
    world.step(period_ns_);
    time_ns_ += period_ns_;
  }
  const bool damps = robot_.any_watchdog_tripped();
  if (damps && !damped_) ++session_.releases;
  damped_ = damps;
  told_ += due;
  if (told_ >= divisor_) {
    told_ = 0;
    robot_.look(model);
    if (robot_.tell(packet_)) (void)dds_write(states_, packet_.words.data());
  }
  return !is_over(std::int64_t{periods} * period_ns_);
}

bool UnitreeEmulator::is_over(std::int64_t beat_ns) noexcept {
  silent_ns_ += beat_ns;
  const std::uint32_t writers = writers_of(commands_) - (second_ > 0 ? 1 : 0);
  const bool silent = driven_ && silent_ns_ > (in_step_ ? in_step_timeout_ns : session_over_ns);
  const bool gone = writers == 0 && (driven_ || readers_of(states_) == 0);
  if (!silent && !gone) return false;
  session_.left = !robot_.any_torque();
  faults_.end(robot_);
  robot_.switch_power();
  write_beside();
  return true;
}

std::vector<kadans::PlantCount> UnitreeEmulator::link_counts() const {
  const EmulatedRobot::Counts& is = robot_.counts();
  return {{"commands", is.commands},
          {"corrupt", is.corrupt},
          {"foreign", is.foreign},
          {"refused", is.refused},
          {"states", is.states}};
}

}  // namespace unitree
