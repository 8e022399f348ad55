// A board's registers through LBP16: datagrams of commands, answered by one datagram with what was read.
//
// A command is a word of 16 bits (write, address follows, memory space, element size, address counts up, count), the
// address in bytes, and what is written. A tick's datagram is: the request's number to scratch memory; the reads; that
// number and the number of the newest writes, read back; the writes; their number. So an answer says which request it
// answers, and which writes the board had before that. All is little endian, whatever this machine is.
//
// UDP's own checksum guards the bits; beyond that an answer counts only with its right length, the number of a request
// at both of its ends, and the cookie of a HostMot2 board.
#pragma once

#include <array>
#include <memory>

#include "board_link.h"
#include "datagram_port.h"

namespace kadans::hostmot2 {

inline constexpr std::size_t datagram_bytes_max = 1400;

class LbpLink final : public BoardLink {
 public:
  // `wait_ns`: how long a tick looks for an answer that is not there yet.
  LbpLink(std::unique_ptr<DatagramPort> port, std::int64_t patience_ns, std::int64_t wait_ns);

  bool read(std::uint16_t address, std::span<std::uint32_t> into) override;
  bool write(RegisterWrite one) override;
  bool card_name(std::string& name) override;
  std::string why_silent() const override { return port_->why_silent(); }
  void lay_out(const TickLayout& layout) override;

  void send(std::span<const std::uint32_t> words) noexcept override;
  bool collect(std::span<std::uint32_t> words, Sample& sample) noexcept override;
  void write_all(std::span<const RegisterWrite> writes) noexcept override;
  std::int64_t now_ns() const noexcept override { return port_->now_ns(); }
  const LinkCounts& counts() const noexcept override { return counts_; }
  std::size_t reply_bytes() const noexcept { return reply_bytes_; }

 private:
  static constexpr int tries = 5, takes_max = 16;
  static constexpr std::size_t kept_times = 64;

  bool exchange(std::size_t request_bytes, std::size_t reply_bytes);
  std::uint32_t u32_at(std::size_t at) const noexcept;

  std::unique_ptr<DatagramPort> port_;
  std::int64_t patience_ns_, wait_ns_;
  std::array<std::uint8_t, datagram_bytes_max> asked_{}, answer_{}, tick_{};
  TickLayout layout_;
  std::size_t reply_bytes_ = 0, writes_at_ = 0, usual_words_ = 0;
  std::uint64_t sent_ = 0;
  std::uint32_t heard_ = 0;  // number of the newest writes that the board had
  std::array<std::int64_t, kept_times> sent_at_ns_{};
  Arrivals arrivals_;
  LinkCounts counts_;
};

}  // namespace kadans::hostmot2
