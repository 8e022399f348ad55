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
inline constexpr std::uint16_t lbp_udp_port = 27181;

// Writes a datagram of commands; what does not fit is left out, and ok() tells of it.
class LbpWriter {
 public:
  enum class Space : std::uint8_t { registers = 0, timers = 4, card = 7 };

  explicit LbpWriter(std::span<std::uint8_t> into) noexcept : into_(into) {}
  // Elements of the space's own size: 32 bits of registers, 16 of the others.
  LbpWriter& read(Space space, std::uint16_t address, std::size_t elements) noexcept;
  // The data follow by the caller: u16 or u32.
  LbpWriter& write(Space space, std::uint16_t address, std::size_t elements) noexcept;
  LbpWriter& u16(std::uint16_t value) noexcept;
  LbpWriter& u32(std::uint32_t value) noexcept;
  std::size_t size() const noexcept { return size_; }
  bool ok() const noexcept { return ok_; }

 private:
  LbpWriter& command(bool writes, Space space, std::uint16_t address, std::size_t elements) noexcept;
  std::span<std::uint8_t> into_;
  std::size_t size_ = 0;
  bool ok_ = true;
};

class LbpLink final : public BoardLink {
 public:
  // `wait_ns`: how long a tick looks for an answer that is not there yet.
  LbpLink(std::unique_ptr<DatagramPort> port, std::int64_t patience_ns, std::int64_t wait_ns);

  bool read(std::uint16_t address, std::span<std::uint32_t> into) override;
  bool write(RegisterWrite one) override;
  bool card_name(std::string& name) override;
  void lay_out(const TickLayout& layout) override;

  void send(std::span<const std::uint32_t> words) noexcept override;
  bool collect(std::span<std::uint32_t> words, Sample& sample) noexcept override;
  void write_all(std::span<const RegisterWrite> writes) noexcept override;
  std::int64_t now_ns() const noexcept override { return port_->now_ns(); }
  const LinkCounts& counts() const noexcept override { return counts_; }
  std::size_t request_bytes() const noexcept { return usual_bytes_; }
  std::size_t reply_bytes() const noexcept { return reply_bytes_; }

 private:
  static constexpr int tries = 5, takes_max = 16;
  static constexpr std::size_t kept_times = 64;

  bool exchange(std::size_t request_bytes, std::size_t reply_bytes);
  void put_words(std::span<const RegisterBlock> blocks, std::span<const std::uint32_t> words, std::size_t at) noexcept;
  std::uint32_t u32_at(std::size_t at) const noexcept;
  std::uint16_t u16_at(std::size_t at) const noexcept;

  std::unique_ptr<DatagramPort> port_;
  std::int64_t patience_ns_, wait_ns_;
  std::array<std::uint8_t, datagram_bytes_max> asked_{}, answer_{}, tick_{};
  TickLayout layout_;
  std::size_t number_at_ = 0;  // of the request, in tick_; that of its writes stands behind them
  std::size_t usual_bytes_ = 0, reply_bytes_ = 0, writes_at_ = 0, usual_words_ = 0;
  std::uint64_t sent_ = 0;
  std::uint32_t heard_ = 0;  // number of the newest writes that the board had
  std::array<std::int64_t, kept_times> sent_at_ns_{};
  Arrivals arrivals_;
  LinkCounts counts_;
};

}  // namespace kadans::hostmot2
