#include "hostmot2_plant.h"

#include <algorithm>
#include <cmath>

#include "signal/input_file.h"
#include "signal/number_text.h"

namespace kadans::hostmot2 {
namespace {

constexpr NamedCount<LinkCounts> link_count_names[] = {
    {"sent", &LinkCounts::sent, "datagrams to the boards, one a tick"},
    {"unsent", &LinkCounts::unsent, "datagrams that the system did not take"},
    {"received", &LinkCounts::received, "replies"},
    {"lost", &LinkCounts::lost, "replies that never came"},
    {"unheard", &LinkCounts::unheard, "of these, requests that a board never had"},
    {"late", &LinkCounts::late, "replies to another request than the last one"},
    {"reordered", &LinkCounts::reordered, "replies that came behind a newer one and were not used"},
    {"duplicates", &LinkCounts::duplicates, "replies that came again"},
    {"refused", &LinkCounts::refused, "datagrams that answer nothing that was asked"},
    {"short", &LinkCounts::short_, "of these, those of another length"},
};

}  // namespace

HostMot2Plant::HostMot2Plant(HostMot2Settings settings, PlantSite site, std::vector<std::unique_ptr<BoardLink>> links)
    : settings_(std::move(settings)), site_(std::move(site)) {
  for (std::size_t i = 0; i < settings_.boards.size(); ++i)
    boards_.emplace_back(settings_.boards[i], std::move(links.at(i)));
  fresh_.resize(boards_.size());
  repair_.resize(boards_.size());
  const double period_s = 1e-9 * static_cast<double>(site_.layout.period_ns);
  const double bus_period_s = settings_.period_s > 0 ? settings_.period_s : period_s;
  divisor_ = settings_.bus_divisor(site_.layout.period_ns);
  if (std::abs(bus_period_s - divisor_ * period_s) > 1e-9)
    refuse(site_.file, "plant.hm2-eth.period_s must be a whole multiple of the control period");
  if (!(settings_.watchdog_s >= 2 * bus_period_s))
    refuse(site_.file, "plant.hm2-eth.watchdog_s must be at least two periods of the bus, each of which pets it");
  silent_ticks_max_ = std::max(5U, static_cast<std::uint32_t>(std::ceil(settings_.watchdog_s / bus_period_s)));
}

HostMot2Plant::~HostMot2Plant() { close(); }

std::size_t HostMot2Plant::place_in(const std::vector<std::string>& names, const std::string& name,
                                    const char* what) const {
  const auto found = std::ranges::find(names, name);
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  refuse(site_.file, "plant.hm2-eth." + std::string(what) + "." + name + ": the robot has no such name; it has " +
                         (names.empty() ? "none" : listed(names)));
}

void HostMot2Plant::wire() {
  const std::vector<std::string> drives = drive_names(site_.layout.joints, site_.transmissions);
  for (const DriveWiring& wiring : settings_.drives) {
    const std::size_t board = settings_.board_number(wiring.board);
    axes_.push_back({board, Axis(wiring, boards_[board], place_in(drives, wiring.drive, "drives"))});
  }
  for (const FootWiring& wiring : settings_.feet) {
    Foot foot{.number = place_in(site_.layout.feet, wiring.foot, "feet"),
              .board = settings_.board_number(wiring.board),
              .closed_N = wiring.closed_N};
    for (std::size_t i = 0; i < foot.corners.size(); ++i) foot.corners[i] = {foot.board, wiring.corners[i]};
    feet_.push_back(foot);
  }
  for (const InputWiring& wiring : settings_.inputs)
    inputs_.push_back({.number = place_in(site_.layout.sensors, wiring.name, "inputs"),
                       .pin = {settings_.board_number(wiring.board), wiring.pin}});
  emergency_ = {settings_.emergency ? settings_.board_number(settings_.emergency_board) : 0, settings_.emergency};
}

bool HostMot2Plant::open(bool (*give_up)() noexcept) {
  for (Board& board : boards_) {
    if (give_up != nullptr && give_up()) return false;
    board.open(settings_);
  }
  wire();
  open_ = true;
  // The first reading is here before the loop. Nothing is an output yet.
  for (std::size_t i = 0; i < boards_.size(); ++i) {
    boards_[i].send();
    const std::int64_t until_ns = boards_[i].link().now_ns() + std::llround(1e9 * settings_.patience_s);
    while (!(fresh_[i] = boards_[i].collect()) && boards_[i].link().now_ns() < until_ns) {
    }
  }
  return true;
}

void HostMot2Plant::close() noexcept {
  if (!open_) return;
  for (Board& board : boards_) board.close();
  open_ = false;
}

void HostMot2Plant::read(SensorFrame& sensors) noexcept {
  sensors.joint_count = static_cast<std::uint32_t>(site_.layout.joints.size());
  sensors.foot_count = static_cast<std::uint32_t>(site_.layout.feet.size());
  sensors.channel_count = static_cast<std::uint32_t>(site_.layout.sensors.size());
  sensors.time_ns = boards_.empty() ? 0 : boards_.front().link().now_ns();
  age_ms_ = 0;
  counts_ = {};
  for (std::size_t i = 0; i < boards_.size(); ++i) {
    const bool bitten = boards_[i].bitten();
    // The first one of all came in open(). On a busy machine it has grown old when the loop begins: it is asked again.
    if (!driven_) {
      if (seconds_between(boards_[i].time_ns(), sensors.time_ns) > settings_.watchdog_s) boards_[i].send();
      fresh_[i] = boards_[i].collect() || fresh_[i];
    } else {
      fresh_[i] = asked_ && boards_[i].collect();
    }
    if (boards_[i].bitten() && !bitten) ++bites_;
    const LinkCounts& of = boards_[i].link().counts();
    for (const auto& one : link_count_names) counts_.*one.value += of.*one.value;
    age_ms_ = std::max(age_ms_, 1e3 * seconds_between(boards_[i].time_ns(), sensors.time_ns));
  }
  limited_ = strange_ = 0;
  for (Wired& wired : axes_) {
    wired.axis.take(fresh_[wired.board], silent_ticks_max_);
    sensors.joints[wired.axis.joint()] = wired.axis.sample();
    limited_ += wired.axis.limited();
    strange_ += wired.axis.strange();
  }
  drives_to_joints(site_.transmissions, sensors);
  for (const Foot& foot : feet_) {
    FootSample& sample = sensors.feet[foot.number];
    for (std::size_t i = 0; i < foot.corners.size(); ++i)
      sample.force_N[i] = foot.corners[i].active(boards_) ? foot.closed_N : 0;
    if (fresh_[foot.board]) ++sample.sequence;
  }
  for (const Input& input : inputs_) {
    sensors.channels[input.number].value = input.pin.active(boards_) ? 1 : 0;
    if (fresh_[input.pin.board]) ++sensors.channels[input.number].sequence;
  }
  sensors.emergency = emergency_.active(boards_);
}

void HostMot2Plant::write(const ActuationFrame& actuation) noexcept {
  copy_used(actuation, drives_);
  for (const Transmission& transmission : site_.transmissions) transmission.to_drives(drives_);
  const double period_s = 1e-9 * static_cast<double>(site_.layout.period_ns);
  // From the first tick on there are outputs, and a watchdog that is petted.
  if (!driven_) std::fill(repair_.begin(), repair_.end(), true);
  asked_ = !driven_ || ++tick_ % divisor_ == divisor_ - 1;
  driven_ = true;
  for (Wired& wired : axes_) {
    const std::size_t joint = wired.axis.joint();
    const bool there = joint < drives_.joint_count;
    const bool repair = wired.axis.plan(there ? drives_.joints[joint] : JointActuation{},
                                        there ? drives_.drives[joint] : DriveRequest{}, period_s);
    if (repair) repair_[wired.board] = true;
  }
  if (!asked_) return;
  for (std::size_t i = 0; i < boards_.size(); ++i) {
    if (repair_[i]) boards_[i].repair();
    repair_[i] = false;
    boards_[i].send();
  }
}

std::vector<PlantCount> HostMot2Plant::link_counts() const {
  std::vector<PlantCount> counts = counts_of(link_count_names, counts_);
  counts.push_back({"bites", bites_});
  counts.push_back({"strange", strange_});
  counts.push_back({"limited", limited_});
  return counts;
}

void HostMot2Plant::declare_signals(SignalTable& table) const {
  declare_counts(table, link_count_names, counts_);
  table.add({"plant.bus.bites", "1", "how often a board's watchdog released its outputs"}, &bites_);
  table.add({"plant.bus.strange", "1", "readings that no joint can give: not used"}, &strange_);
  table.add({"plant.bus.limited", "1", "efforts beyond what an amplifier gives, cut to that"}, &limited_);
  table.add({"plant.bus.age_ms", "ms", "age of the oldest board's newest reading"}, &age_ms_);
}

}  // namespace kadans::hostmot2
