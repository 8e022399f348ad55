// The control side's end of the connection to a plant on another machine.
//
// Each tick reads all datagrams that have come and uses the newest sample. When none has come, or the newest answers an
// actuation that is too old, the last sample is kept as it is. Its readings are then not new: the estimator counts how
// long each sensor has been silent, and the safety layer uses that count. Up to safety.silent_ticks_max ticks have no
// effect; then the sensors are silent and the ladder follows.
//
// Age is counted in actuations sent. So neither side needs the other's clock, and ticks that the control thread itself
// missed make no sample older. When more than a few samples come at once, after a gap, even the newest may have waited
// long in a full buffer: it is not used, the next tick's sample is.
//
// One owner, the control thread; read and write make one or two system calls each that do not block.
#pragma once

#include <cstdint>

#include "datagram_socket.h"
#include "kadans/plant/plant.h"
#include "wire.h"

namespace kadans {

class UdpPlant final : public Plant {
 public:
  // `session` distinguishes this run from others: draw it at random. Throws std::invalid_argument.
  UdpPlant(const UdpSettings& settings, const PlantLayout& layout, DatagramSocket socket, std::uint64_t session);
  ~UdpPlant() override;  // closes

  // Greets the plant until it welcomes us and a first sample is here.
  bool open(bool (*give_up)() noexcept = nullptr) override;
  // open in steps: greet() sends a greeting (false: not sent); welcomed() says whether open is done, and throws when
  // the plant refuses for good.
  bool greet();
  bool welcomed();
  // Before the loop: the signals plant.link.*, which count the datagrams.
  void declare_signals(SignalTable& table) const override;

  void read(SensorFrame& sensors) noexcept override;
  void write(const ActuationFrame& actuation) noexcept override;
  void close() noexcept override;  // says goodbye, so that the plant need not wait for its timeout

  std::vector<PlantCount> link_counts() const override { return counts_of(statistics_); }
  const DatagramCounts& statistics() const noexcept { return statistics_; }  // control thread, or after it
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
  DatagramCounts statistics_;
  double round_trip_ticks_ = 0;
  Datagram out_{};
};

}  // namespace kadans
