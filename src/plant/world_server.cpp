#include "world_server.h"

#include <algorithm>
#include <functional>
#include <utility>

namespace kadans {

// What an emulator sees of the world: its own robot. Where it lets time pass, the emulators after it take what came for
// theirs, and the world steps once.
struct WorldServer::Seat final : World {
  explicit Seat(std::unique_ptr<PlantEmulator> serves) : emulator(std::move(serves)) {}

  std::size_t robot_count() const noexcept override { return 1; }
  WorldRobot& robot(std::size_t) noexcept override { return *own; }
  void step(std::int64_t) override {
    driven = stepped = true;
    pass();
  }
  void hash(StateHash&) const noexcept override {}

  // Where it stood in the first beat.
  const ActuationFrame& held(const PlantTruth& truth) noexcept {
    for (; hold.joint_count < truth.joint_count; ++hold.joint_count)
      hold.joints[hold.joint_count] = {.position_rad = truth.position_rad[hold.joint_count],
                                       .mode = ActuationMode::position};
    return hold;
  }
  void leave_world() noexcept {
    in_session = driven = false;
    hold = {};
  }

  std::unique_ptr<PlantEmulator> emulator;
  WorldRobot* own = nullptr;
  std::function<void()> pass;
  bool in_session = false;
  bool driven = false;   // ever, in this world
  bool stepped = false;  // in this beat
  ActuationFrame hold;
};

WorldServer::WorldServer(std::vector<std::unique_ptr<PlantEmulator>> emulators) {
  for (auto& emulator : emulators) seats_.push_back(std::make_unique<Seat>(std::move(emulator)));
}

WorldServer::~WorldServer() = default;

PlantEmulator& WorldServer::emulator(std::size_t robot) noexcept { return *seats_[robot]->emulator; }

void WorldServer::look(World& world) {
  for (std::size_t i = 0; i < seats_.size(); ++i) {
    seats_[i]->own = &world.robot(i);
    seats_[i]->emulator->look(*seats_[i]);
  }
}

bool WorldServer::await(int milliseconds) {
  const int each_ms = std::max(1, milliseconds / static_cast<int>(seats_.size()));
  for (auto& seat : seats_) seat->in_session = seat->in_session || seat->emulator->await(each_ms);
  return std::ranges::all_of(seats_, [](const auto& seat) { return seat->in_session; });
}

bool WorldServer::beat(World& world, std::uint32_t periods, std::int64_t dt_ns) {
  if (seats_.size() == 1) {
    Seat& alone = *seats_.front();
    if (!alone.emulator->beat(world, periods)) leave(0);
    return alone.in_session;
  }
  for (std::uint32_t i = 0; i < periods; ++i) {
    wanted_ = false;
    beat_from(0, world, dt_ns);
  }
  if (std::ranges::any_of(seats_, [](const auto& seat) { return seat->in_session; })) return true;
  for (auto& seat : seats_) seat->leave_world();
  return false;
}

void WorldServer::abandon() {
  for (std::size_t i = 0; i < seats_.size(); ++i) {
    if (seats_[i]->in_session) leave(i, true);
    seats_[i]->leave_world();
  }
}

// The robots before `first` have taken what came, and wait in the steps of their seats.
void WorldServer::beat_from(std::size_t first, World& world, std::int64_t dt_ns) {
  if (first == seats_.size()) {
    if (wanted_) world.step(dt_ns);
    return;
  }
  Seat& seat = *seats_[first];
  WorldRobot& robot = world.robot(first);
  seat.own = &robot;
  seat.stepped = false;
  seat.pass = [&] {
    wanted_ = true;
    beat_from(first + 1, world, dt_ns);
  };
  if (!seat.driven) robot.write(seat.held(robot.truth()));
  if (!seat.in_session) {
    seat.emulator->look(seat);
    seat.in_session = seat.emulator->await(0);
  } else if (!seat.emulator->beat(seat, 1)) {
    leave(first);
  }
  if (!seat.stepped) beat_from(first + 1, world, dt_ns);
}

void WorldServer::leave(std::size_t robot, bool abandoned) {
  Seat& seat = *seats_[robot];
  seat.in_session = false;
  const std::lock_guard lock(mutex_);
  ended_.push_back(
      {robot, seat.emulator->peer_name(), seat.emulator->session(), seat.emulator->link_counts(), abandoned});
}

std::vector<WorldServer::Ended> WorldServer::take_ended() {
  const std::lock_guard lock(mutex_);
  return std::exchange(ended_, {});
}

}  // namespace kadans
