#include "unitree_plant.h"

#include <algorithm>
#include <cstdio>
#include <string>
#include <utility>

#include "dds_link.h"
#include "kadans/model/transmission.h"
#include "kadans/signal/input_error.h"

namespace unitree {
namespace {

constexpr std::int64_t wait_max_ns = 20'000'000;
constexpr double other_kind_s = 0.5;  // until then the right one may be found first

constexpr kadans::NamedCount<Counts> named_counts[] = {
    {"states", &Counts::states, "states of the robot that were used"},
    {"corrupt", &Counts::corrupt, "states with a wrong checksum"},
    {"stale", &Counts::stale, "states that were not newer than the one before"},
    {"not_finite", &Counts::not_finite, "states with a number that is none"},
    {"commands", &Counts::commands, "commands that were sent"},
    {"unsent", &Counts::unsent, "commands that DDS did not take"},
    {"refused", &Counts::refused, "actuations of a joint that no command can hold: it damped"},
    {"foreign", &Counts::foreign, "commands of somebody else"},
    {"restarts", &Counts::restarts, "how often the robot's clock began anew"},
    {"lost", &Counts::lost, "messages that the robot's motors say they missed"},
};

}  // namespace

UnitreePlant::UnitreePlant(const Settings& settings, kadans::PlantSite site, std::unique_ptr<DriverLink> link)
    : settings_(settings),
      site_(std::move(site)),
      motors_(motors_of(settings_, site_)),
      own_thread_(link == nullptr),
      link_(std::move(link)) {
  if (settings_.foot_N_per_count == 0 || settings_.kind->family != Family::go) return;
  for (const std::string& foot : site_.layout.feet) feet_.push_back(place_of_foot(foot));
  if (std::ranges::find(feet_, feet_max) == feet_.end()) return;
  throw kadans::InputError({.file = site_.file,
                            .message = "plant.unitree.foot_N_per_count: a foot's name must begin with front_right, "
                                       "front_left, rear_right or rear_left, or with FR, FL, RR or RL"});
}

UnitreePlant::~UnitreePlant() { close(); }

bool UnitreePlant::open(bool (*give_up)() noexcept) {
  if (link_ == nullptr) link_ = make_dds_link(settings_);
  driver_ = std::make_unique<LowDriver>(*link_, settings_, motors_);
  const std::int64_t begin_ns = link_->now_ns();
  const double patience_s = own_thread_ ? settings_.connect_timeout_s : 0;
  while (!driver_->take()) {
    if (give_up != nullptr && give_up()) return false;
    const double waited_s = kadans::seconds_between(begin_ns, link_->now_ns());
    const std::string other = waited_s < other_kind_s ? "" : link_->other_kind();
    if (!other.empty() || waited_s >= patience_s) fail_without_state(other);
    link_->wait(link_->now_ns() + wait_max_ns);
  }
  sample_.publish(driver_->sample());  // the first reading is here before the loop
  if (own_thread_) thread_.start("unitree", "the bus", [this] { loop(); });
  return true;
}

void UnitreePlant::fail_without_state(const std::string& other_kind) const {
  std::array<char, 32> seconds{};
  std::snprintf(seconds.data(), seconds.size(), "%g s", settings_.connect_timeout_s);
  std::string why = std::string("no state within ") + seconds.data() + ": ";
  if (!other_kind.empty()) {
    why =
        "rt/lowstate is written there as " + other_kind + ", by a robot of another kind than plant.unitree.robot says";
  } else if (driver_->sample().counts.corrupt > 0) {
    why +=
        "states come, but with wrong checksums; for a simulator that makes none set plant.unitree.checksums to false";
  } else if (link_->has_peer()) {
    why += "somebody is there who could write rt/lowstate, and does not";
  } else {
    why +=
        "nobody writes rt/lowstate there. Is the robot on, has the network card an address in its network, and is it "
        "the card of plant.unitree.interface, or --peer?";
  }
  throw kadans::InputError(
      {.file = site_.file, .message = std::string(settings_.kind->name) + " on " + settings_.place() + ": " + why});
}

void UnitreePlant::loop() noexcept {
  const std::int64_t period_ns = settings_.period_ns();
  std::int64_t due_ns = link_->now_ns();
  while (!thread_.asked_to_stop()) {
    if (driver_->take()) sample_.publish(driver_->sample());
    const std::int64_t now_ns = link_->now_ns();
    if (now_ns < due_ns) {
      link_->wait(due_ns);
      continue;
    }
    run_cycle();
    due_ns += period_ns;
    if (due_ns < now_ns) due_ns += (now_ns - due_ns + period_ns - 1) / period_ns * period_ns;  // on the grid again
  }
}

void UnitreePlant::run_cycle() noexcept {
  (void)driver_->take();
  {
    const auto asked = actuation_.read();
    driver_->run(*asked);
  }
  sample_.publish(driver_->sample());
}

void UnitreePlant::close() noexcept {
  thread_.stop();
  if (driver_ != nullptr) driver_->release();
  driver_.reset();
  if (own_thread_) link_.reset();
}

void UnitreePlant::write(const kadans::ActuationFrame& actuation) noexcept {
  copy_used(actuation, drives_);
  for (const kadans::Transmission& transmission : site_.transmissions) transmission.to_drives(drives_);
  actuation_.publish(drives_);
}

void UnitreePlant::read(kadans::SensorFrame& sensors) noexcept {
  const auto sample = sample_.read();
  sensors.joint_count = static_cast<std::uint32_t>(motors_.size());
  sensors.foot_count = static_cast<std::uint32_t>(feet_.size());  // none: they are not measured, and not silent
  sensors.channel_count = static_cast<std::uint32_t>(site_.layout.sensors.size());
  sensors.time_ns = link_ == nullptr ? 0 : link_->now_ns();
  kadans::copy_first(sample->joints, sample->count, sensors.joints);
  sensors.imu = sample->imu;
  sensors.supply_V = sample->supply_V;
  for (std::size_t i = 0; i < feet_.size(); ++i) {
    sensors.feet[i].force_N.fill(sample->foot_N[feet_[i]] / kadans::sensors_per_foot);
    sensors.feet[i].sequence = sample->imu.sequence;
  }
  counts_ = sample->counts;
  age_ms_ = 1e3 * kadans::seconds_between(sample->imu.time_ns, sensors.time_ns);
  drives_to_joints(site_.transmissions, sensors);
}

std::vector<kadans::PlantCount> UnitreePlant::link_counts() const { return kadans::counts_of(named_counts, counts_); }

void UnitreePlant::declare_signals(kadans::SignalTable& table) const {
  kadans::declare_counts(table, named_counts, counts_);
  table.add({"plant.bus.age_ms", "ms", "age of the newest state"}, &age_ms_);
}

}  // namespace unitree
