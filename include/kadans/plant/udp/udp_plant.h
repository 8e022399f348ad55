// The control side's end of a plant on another machine.
//
// A tick reads all that has come and uses the newest sample; when none came, or the newest answers an actuation that is
// too old, the last sample is held as it is. Its readings are then not new ones, so the estimator counts how long each
// sensor has been silent and the safety layer goes by that: up to safety.silent_ticks_max ticks pass as if nothing
// were, then the sensors are silent and the ladder follows. Age is counted in actuations sent, so neither side needs
// the other's clock, and ticks that the control thread itself missed make nothing old. When more than a few samples
// came at once, after a gap, the newest of them may have lain for long behind a full buffer: the next tick's counts.
//
// One owner, the control thread; read and write make one or two system calls each that do not block.
#pragma once

#include <cstdint>

#include "kadans/plant/plant.h"
#include "kadans/plant/udp/arrivals.h"
#include "kadans/plant/udp/datagram_socket.h"
#include "kadans/plant/udp/settings.h"
#include "kadans/plant/udp/wire.h"

namespace kadans {

class UdpPlant final : public Plant {
 public:
  // `session` tells this run from others: draw it. Throws std::invalid_argument.
  UdpPlant(const UdpSettings& settings, const PlantLayout& layout, DatagramSocket socket, std::uint64_t session);
  ~UdpPlant() override;  // closes

  // Greets the plant until it welcomes us and a first sample is here.
  bool open(bool (*give_up)() noexcept = nullptr) override;
  // The same in steps: whether it is done; throws when the plant refuses for good.
  bool greet();
  bool welcomed();
  // Before the loop: plant.link.*, what became of the datagrams.
  void declare_signals(SignalTable& table) const override;

  void read(SensorFrame& sensors) noexcept override;
  void write(const ActuationFrame& actuation) noexcept override;
  void close() noexcept override;  // the plant need not wait for us

  std::vector<PlantCount> link_counts() const override { return counts_of(statistics_); }
  const UdpStatistics& statistics() const noexcept { return statistics_; }  // control thread, or after it
  bool released() const noexcept { return more_.released; }
  double round_trip_ticks() const noexcept { return round_trip_ticks_; }

 private:
  static constexpr std::size_t tick_takes_max = 4 * DatagramSocket::batch_max, piled_up = 8;

  bool take(Bytes datagram) noexcept;
  bool is_good(Bytes datagram, WireHead& head) noexcept;
  [[noreturn]] void refuse(const WireHead& head, Bytes datagram) const;
  WireHead next_head(WireKind kind) noexcept;
  void send(Bytes datagram) noexcept;

  UdpSettings settings_;
  PlantLayout layout_;
  PlantWire wire_;
  DatagramSocket socket_;
  std::uint64_t session_;
  std::uint64_t round_trip_max_ticks_;

  std::uint64_t sent_ = 0;     // datagrams: their sequence
  std::uint64_t written_ = 0;  // actuations
  std::uint64_t answered_ = 0;
  bool welcome_ = false, sampled_ = false, busy_ = false, left_ = false;
  SensorFrame newest_, held_;
  SensorsOnWire more_;
  Arrivals arrivals_;
  UdpStatistics statistics_;
  double round_trip_ticks_ = 0;
  Datagram out_{};
};

}  // namespace kadans
