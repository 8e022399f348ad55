// A board's registers as memory: a PCI card's resource file of 64 KiB (5I20, 4I65), mapped.
//
// The bus answers at once, so send() itself reads and writes; nothing is lost or late on it. Little endian, as the
// card.
#pragma once

#include <string>
#include <vector>

#include "board_link.h"
#include "signal/monotonic_clock.h"

namespace kadans::hostmot2 {

class MappedLink : public BoardLink {
 public:
  static constexpr std::size_t bytes = 0x10000;

  explicit MappedLink(const std::string& path);  // throws InputError
  ~MappedLink() override;

  bool read(std::uint16_t address, std::span<std::uint32_t> into) override;
  bool write(RegisterWrite one) override;
  bool card_name(std::string& name) override;
  void lay_out(const TickLayout& layout) override;
  void send(std::span<const std::uint32_t> words) noexcept override;
  bool collect(std::span<std::uint32_t> words, Sample& sample) noexcept override;
  void write_all(std::span<const RegisterWrite> writes) noexcept override;
  std::int64_t now_ns() const noexcept override { return monotonic_ns(); }
  const LinkCounts& counts() const noexcept override { return counts_; }

 private:
  volatile std::uint32_t* registers_ = nullptr;
  TickLayout layout_;
  std::vector<std::uint32_t> read_;
  Sample sample_;
  bool fresh_ = false;
  LinkCounts counts_;
};

}  // namespace kadans::hostmot2
