// The plant's end of the connection: serves a model, or hardware behind the same seam, to one control engine at a time
// on another machine.
//
// The first control engine that greets with the right robot becomes the peer of a session; datagrams from elsewhere are
// refused. The plant's time begins with the peer's first actuation, so that a model does not fall before it is driven.
// From then on each beat takes the datagrams that have come, applies the newest actuation, lets the time pass and sends
// a sample. Without an actuation for watchdog_s the plant damps its joints itself, as drives do when their bus is
// silent, until an actuation comes. The session ends after peer_timeout_s without an actuation, or when the peer says
// goodbye.
//
// In step with its peer, whose clock may be slow or stand still, the plant lets a period pass for each actuation that
// the peer has sent, and is patient for in_step_timeout_s. A sample follows each step.
#pragma once

#include <cstdint>

#include "datagram_socket.h"
#include "kadans/plant/plant_type.h"
#include "wire.h"

namespace kadans {

class PlantServer final : public PlantEmulator {
 public:
  // Throws std::invalid_argument.
  PlantServer(const UdpSettings& settings, const PlantLayout& layout, DatagramSocket socket);

  bool await(int milliseconds) noexcept override;
  bool beat(World& world, std::uint32_t periods) override;
  bool step_with_peer() noexcept override;
  std::string peer_name() const override { return peer_.text(); }
  const Session& session() const noexcept override { return session_; }
  std::vector<PlantCount> link_counts() const override { return counts_of(link_); }
  const DatagramCounts& link() const noexcept { return link_; }
  const PeerAddress& peer() const noexcept { return peer_; }
  bool released() const noexcept { return released_; }

 private:
  static constexpr std::size_t beat_takes_max = 4 * DatagramSocket::batch_max;
  static constexpr double in_step_timeout_s = 60;
  static constexpr std::uint32_t in_step_ahead_max = 10;

  void take_all() noexcept;
  void take(Bytes datagram, const PeerAddress& from) noexcept;
  bool greeted(const WireHead& head, PlantWire::Check check, Bytes datagram, const PeerAddress& from) noexcept;
  void answer(WireKind kind, WireRefusal refusal, std::uint64_t session, const PeerAddress& to) noexcept;
  void take_actuation(const WireHead& head, Bytes datagram) noexcept;
  void begin(std::uint64_t session, const PeerAddress& from) noexcept;
  std::uint32_t due(std::uint32_t periods) noexcept;
  const ActuationFrame& damping(const PlantTruth& truth) noexcept;

  UdpSettings settings_;
  PlantWire wire_;
  DatagramSocket socket_;
  std::int64_t period_ns_;

  bool in_step_ = false;
  bool in_session_ = false, answered_stranger_ = false;
  PeerAddress peer_;
  std::uint64_t session_number_ = 0, sent_ = 0;
  std::uint64_t newest_actuation_ = 0, stepped_ = 0;  // stepped_: for that many of the peer's ticks
  std::int64_t silent_ns_ = 0;                        // since the newest actuation
  bool driven_ = false;                               // there was an actuation
  bool released_ = false;
  ActuationFrame actuation_, damping_;
  SensorFrame sensors_;
  Arrivals arrivals_;
  Session session_;
  DatagramCounts link_;
  Datagram out_{};
};

}  // namespace kadans
