// Serves the robots of one world, each through an emulator of its own to a program of its own.
//
// The world's time begins when each robot has had its peer and the first of them drives. In a beat every emulator first
// takes what came for its robot, then the world steps once for all of them, then each peer is answered: no robot's
// actuation waits longer than another's. A robot that has not been driven yet holds the position in which it stands, as
// drives do that were just switched on. When the peer of one robot goes, the world goes on; this robot's drives do what
// they do without a peer, and may get another.
//
// Threads: look() and await() before the world's time, beat() in it, abandon() after it, by one thread at a time;
// take_ended() by any thread.
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "kadans/plant/plant_type.h"

namespace kadans {

class WorldServer {
 public:
  // A session that is over.
  struct Ended {
    std::size_t robot = 0;
    std::string peer;
    PlantEmulator::Session session;
    std::vector<PlantCount> link_counts;
    bool abandoned = false;  // by this side
  };

  // One for each robot, in the order of the world. In step with its peer, and patient with it, is a robot alone.
  explicit WorldServer(std::vector<std::unique_ptr<PlantEmulator>> emulators);
  ~WorldServer();

  std::size_t robot_count() const noexcept { return seats_.size(); }
  PlantEmulator& emulator(std::size_t robot) noexcept;
  // Before await(): what they say of their robots before the first beat is true of this world.
  void look(World& world);
  // Waits at most about this long. True once each robot has a peer, or had one that has gone since.
  bool await(int milliseconds);
  // `periods` of dt_ns passed since the last beat. False: no robot has a peer any more, and the next await() is that of
  // another world. Throws what the world's step throws.
  bool beat(World& world, std::uint32_t periods, std::int64_t dt_ns);
  // After a beat that threw, or the last one that is wanted: whoever has a session has none any more.
  void abandon();
  std::vector<Ended> take_ended();  // since the last call

 private:
  struct Seat;

  void beat_from(std::size_t first, World& world, std::int64_t dt_ns);
  void leave(std::size_t robot, bool abandoned = false);

  std::vector<std::unique_ptr<Seat>> seats_;
  bool wanted_ = false;  // in this beat: a robot's time passes
  std::mutex mutex_;     // of ended_
  std::vector<Ended> ended_;
};

}  // namespace kadans
