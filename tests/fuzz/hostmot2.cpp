// Bytes to both ends of a HostMot2 board's wire: datagrams to the emulated board, replies to the driver, and registers
// that describe a board in whatever way.
//
// An input is a byte that chooses, then pieces: length, bytes.
#include <algorithm>
#include <stdexcept>

#include "fuzz_input.h"
#include "plant/hostmot2/emulator/lbp16_responder.h"
#include "plant/hostmot2/lbp_link.h"
#include "plant/hostmot2/modules.h"

namespace {

using namespace kadans;
using namespace kadans::hostmot2;
using fuzz::require;

class OnePort final : public DatagramPort {
 public:
  explicit OnePort(std::string& reply) : reply_(reply) {}
  bool send(Octets) noexcept override { return true; }
  std::size_t receive(std::span<std::uint8_t> into, std::int64_t) noexcept override {
    const std::size_t size = reply_.size();
    std::copy_n(reply_.begin(), std::min(size, into.size()), into.begin());
    reply_.clear();
    return size;
  }
  void await(std::int64_t until_ns) noexcept override { now_ = until_ns; }
  std::int64_t now_ns() const noexcept override { return now_; }

 private:
  std::string& reply_;
  std::int64_t now_ = 0;
};

// Registers of any content, repeated.
class AnyRegisters final : public BoardLink {
 public:
  explicit AnyRegisters(std::string content) : content_(std::move(content)) {}
  bool read(std::uint16_t address, std::span<std::uint32_t> into) override {
    for (std::size_t i = 0; i < into.size(); ++i) {
      into[i] = 0;
      for (std::size_t k = 0; k < 4; ++k) {
        const std::size_t at = address + 4 * i + k;
        const std::uint32_t byte = content_.empty() ? 0U : static_cast<std::uint8_t>(content_[at % content_.size()]);
        into[i] |= byte << (8 * k);
      }
      const std::size_t at = address + 4 * i;  // as a board that looks like one
      if (at == 0x100) into[i] = 0x55AACAFE;
      if (at == 0x104) into[i] = 0x54534F48;
      if (at == 0x108) into[i] = 0x32544F4D;
      if (at == 0x10C) into[i] &= 0x7FCU;
    }
    return true;
  }
  bool write(RegisterWrite) override { return true; }
  bool card_name(std::string&) override { return true; }
  void lay_out(const TickLayout&) override {}
  void send(std::span<const std::uint32_t>) noexcept override {}
  bool collect(std::span<std::uint32_t>, Sample&) noexcept override { return false; }
  void write_all(std::span<const RegisterWrite>) noexcept override {}
  std::int64_t now_ns() const noexcept override { return 0; }
  const LinkCounts& counts() const noexcept override { return counts_; }

 private:
  std::string content_;
  LinkCounts counts_;
};

void try_board(fuzz::FuzzInput& input) {
  EmulatedBoard board({.encoders = 3, .pwms = 3});
  Lbp16Responder responder(board);
  while (!input.empty()) {
    const std::string piece(input.take(input.byte()));
    const auto* const bytes = reinterpret_cast<const std::uint8_t*>(piece.data());
    require(responder.answer({bytes, piece.size()}).size() <= 1472, "a reply fits into a datagram");
    board.pass(1'000'000);
    for (unsigned pin = 0; pin < board.pins(); ++pin)
      require(board.level(pin) >= 0 && board.level(pin) <= 1, "a pin has a level");
  }
}

void try_driver(fuzz::FuzzInput& input) {
  std::string reply;
  LbpLink link(std::make_unique<OnePort>(reply), 1'000'000, 0);
  link.lay_out({.reads = {{0x3000, 2}}, .writes = {{0x0E00, 1}}, .rare_writes = {}});
  std::array<std::uint32_t, 2> words{};
  BoardLink::Sample sample;
  std::uint32_t newest = 0, sent = 0;
  const std::array<std::uint32_t, 1> pet{0x5A000000};
  while (!input.empty()) {
    link.send(pet);
    ++sent;
    reply = std::string(input.take(input.byte()));
    const std::size_t size = reply.size();
    if (!link.collect(words, sample)) continue;
    require(size == link.reply_bytes(), "a reading has the length that was asked for");
    require(sample.number > newest && sample.number <= sent, "a reading answers a request, once");
    newest = sample.number;
  }
}

void try_modules(fuzz::FuzzInput& input) {
  AnyRegisters registers{std::string(input.take(1000))};
  try {
    const Modules modules = read_modules(registers);
    require(modules.pin_count() <= 144 && modules.ioport->instances == modules.ports, "a board is possible");
    require(modules.encoder ? modules.encoder->at(4, modules.encoder->instances - 1U) < 0xFFFD : true, "within");
  } catch (const std::runtime_error&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::FuzzInput input(data, size);
  switch (input.byte() % 3) {
    case 0:
      try_board(input);
      break;
    case 1:
      try_driver(input);
      break;
    default:
      try_modules(input);
      break;
  }
  return 0;
}
