// The world of a scenario of one robot or several, served over UDP in real time, as `kadans plant SCENARIO` serves it:
// a `kadans run --plant udp` for each robot, on this machine or another one. A program of one's own lets the time pass,
// and sees and moves what hands would move, between two periods (docs/realtime.md). What the scenario's perception says
// is for whoever drives a robot: hand it on, as datagrams (docs/supervisor.md).
//
// One thread, which is late as any other thread is: give it a priority where that counts.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "kadans/control/catalog.h"
#include "kadans/plant/world.h"
#include "kadans/signal/observation.h"

namespace kadans {

class ServedScenario {
 public:
  // `scenario` is the text of a scenario; `file` stands in messages, and its project is where paths begin. `listen`: an
  // address for each robot, "127.0.0.1:7100". Behaviors, events and checks are not served: who drives a robot plays its
  // own. Throws InputError.
  ServedScenario(const std::string& scenario, const std::filesystem::path& file, std::uint64_t seed,
                 const std::vector<std::string>& listen);
  ~ServedScenario();
  ServedScenario(const ServedScenario&) = delete;
  ServedScenario& operator=(const ServedScenario&) = delete;

  // Waits at most about this long. True once each robot has its peer.
  bool await(int milliseconds);
  // Waits for the next period on CLOCK_MONOTONIC and lets it pass. False: no robot has a peer any more. A period that
  // is due already passes at once; of more than ten of them the rest is lost and counted. Throws what the model throws.
  bool step();

  std::int64_t time_ns() const noexcept;
  std::int64_t period_ns() const noexcept;
  std::uint64_t lost_periods() const noexcept;

  // Since the last call: what the scenario's perception of this robot says now, by the number of the entry in its
  // catalog, with the time of the picture.
  std::vector<Observation> take_observed(std::size_t number);
  std::string peer(std::size_t number);  // "192.168.0.2:41234"; "": it has none

  World& world() noexcept;
  std::size_t object(std::string_view name) const;  // throws std::invalid_argument where there is none
  std::size_t robots() const noexcept;
  WorldRobot& robot(std::size_t number);
  const Catalog& catalog(std::size_t number) const;

 private:
  class Served;
  std::unique_ptr<Served> served_;
};

}  // namespace kadans
