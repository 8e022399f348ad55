#include "lbp_link.h"

#include <algorithm>
#include <stdexcept>

namespace kadans::hostmot2 {
namespace {

constexpr std::uint16_t scratch = 0x10;  // two numbers of 32 bits: of the request, of the newest writes
constexpr std::size_t elements_max = 127;
constexpr std::size_t command_bytes = 4;
constexpr std::size_t number_words = 2;  // of 16 bits

std::size_t bytes_of(std::span<const RegisterBlock> blocks) noexcept {
  return command_bytes * blocks.size() + 4 * TickLayout::words(blocks);
}

// Writes a datagram of commands; what does not fit is left out, and ok() tells of it.
class LbpWriter {
 public:
  enum class Space : std::uint8_t { registers = 0, timers = 4, card = 7 };

  explicit LbpWriter(std::span<std::uint8_t> into) noexcept : into_(into) {}
  // Elements of the space's own size: 32 bits of registers, 16 of the others.
  LbpWriter& read(Space space, std::uint16_t address, std::size_t elements) noexcept {
    return command(false, space, address, elements);
  }
  // The data follow by the caller: u16 or u32.
  LbpWriter& write(Space space, std::uint16_t address, std::size_t elements) noexcept {
    return command(true, space, address, elements);
  }
  LbpWriter& u16(std::uint16_t value) noexcept {
    ok_ = ok_ && size_ + 2 <= into_.size();
    if (!ok_) return *this;
    into_[size_++] = static_cast<std::uint8_t>(value);
    into_[size_++] = static_cast<std::uint8_t>(value >> 8U);
    return *this;
  }
  LbpWriter& u32(std::uint32_t value) noexcept {
    return u16(static_cast<std::uint16_t>(value)).u16(static_cast<std::uint16_t>(value >> 16U));
  }
  std::size_t size() const noexcept { return size_; }
  bool ok() const noexcept { return ok_; }

 private:
  LbpWriter& command(bool writes, Space space, std::uint16_t address, std::size_t elements) noexcept {
    ok_ = ok_ && elements >= 1 && elements <= elements_max;
    if (!ok_) return *this;
    const unsigned size = space == Space::registers ? 2 : 1;
    const unsigned word = (writes ? 0x8000U : 0U) | 0x4000U | static_cast<unsigned>(space) << 10U | size << 8U | 0x80U |
                          static_cast<unsigned>(elements);
    return u16(static_cast<std::uint16_t>(word)).u16(address);
  }

  std::span<std::uint8_t> into_;
  std::size_t size_ = 0;
  bool ok_ = true;
};

}  // namespace

LbpLink::LbpLink(std::unique_ptr<DatagramPort> port, std::int64_t patience_ns, std::int64_t wait_ns)
    : port_(std::move(port)), patience_ns_(patience_ns), wait_ns_(wait_ns) {}

std::uint32_t LbpLink::u32_at(std::size_t at) const noexcept {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value |= std::uint32_t{answer_[at + i]} << (8 * i);
  return value;
}

bool LbpLink::exchange(std::size_t request_bytes, std::size_t reply_bytes) {
  for (int i = 0; i < tries; ++i) {
    while (port_->receive(answer_, 0) > 0) {  // answers to what was asked before
    }
    (void)port_->send({asked_.data(), request_bytes});
    const std::int64_t until_ns = port_->now_ns() + patience_ns_;
    while (port_->now_ns() < until_ns) {
      port_->await(until_ns);
      const std::size_t got = port_->receive(answer_, 0);
      if (got == reply_bytes) return true;
      if (got == 0 && port_->now_ns() + 1'000'000 >= until_ns) break;
    }
  }
  return false;
}

bool LbpLink::read(std::uint16_t address, std::span<std::uint32_t> into) {
  for (std::size_t done = 0; done < into.size();) {
    const std::size_t part = std::min(elements_max, into.size() - done);
    LbpWriter request(asked_);
    request.read(LbpWriter::Space::registers, static_cast<std::uint16_t>(address + 4 * done), part);
    if (!exchange(request.size(), 4 * part)) return false;
    for (std::size_t i = 0; i < part; ++i) into[done + i] = u32_at(4 * i);
    done += part;
  }
  return true;
}

bool LbpLink::write(RegisterWrite one) {
  LbpWriter request(asked_);
  request.write(LbpWriter::Space::registers, one.address, 1).u32(one.value);
  request.read(LbpWriter::Space::timers, scratch, number_words);  // its answer says that the write arrived
  return exchange(request.size(), 2 * number_words);
}

bool LbpLink::card_name(std::string& name) {
  constexpr std::size_t characters = 16;
  LbpWriter request(asked_);
  request.read(LbpWriter::Space::card, 0, characters / 2);
  if (!exchange(request.size(), characters)) return false;
  name.clear();
  for (std::size_t i = 0; i < characters && answer_[i] != 0; ++i) {
    const bool printable = answer_[i] > ' ' && answer_[i] < 0x7F;
    name += printable ? static_cast<char>(answer_[i]) : '?';
  }
  return true;
}

void LbpLink::lay_out(const TickLayout& layout) {
  layout_ = layout;
  usual_words_ = TickLayout::words(layout.writes);
  LbpWriter tick(tick_);
  tick.write(LbpWriter::Space::timers, scratch, number_words);
  tick.u32(0);  // send() puts the number there
  tick.read(LbpWriter::Space::timers, scratch, number_words);
  for (const RegisterBlock& block : layout.reads) tick.read(LbpWriter::Space::registers, block.address, block.words);
  tick.read(LbpWriter::Space::timers, scratch, 2 * number_words);
  reply_bytes_ = 6 * number_words + 4 * TickLayout::words(layout.reads);
  writes_at_ = tick.size();
  const std::size_t usual_bytes = writes_at_ + bytes_of(layout.writes) + command_bytes + 2 * number_words;
  const bool fits = std::ranges::all_of(layout.writes, [](const auto& b) { return b.words <= elements_max; }) &&
                    std::ranges::all_of(layout.rare_writes, [](const auto& b) { return b.words <= elements_max; });
  if (!tick.ok() || !fits || usual_bytes + bytes_of(layout.rare_writes) > tick_.size() || reply_bytes_ > answer_.size())
    throw std::length_error("what is read and written in a tick does not fit into a datagram");
  // The board may still have the numbers of an earlier run.
  LbpWriter fresh(asked_);
  fresh.write(LbpWriter::Space::timers, scratch, 2 * number_words).u32(0).u32(0);
  fresh.read(LbpWriter::Space::timers, scratch, number_words);
  (void)exchange(fresh.size(), 2 * number_words);
}

void LbpLink::send(std::span<const std::uint32_t> words) noexcept {
  ++sent_;
  const auto number = static_cast<std::uint32_t>(sent_);
  LbpWriter head(std::span<std::uint8_t>(tick_).subspan(command_bytes));
  head.u32(number);
  LbpWriter tail(std::span<std::uint8_t>(tick_).subspan(writes_at_));
  std::size_t next = 0;
  const auto put = [&](std::span<const RegisterBlock> blocks) {
    for (const RegisterBlock& block : blocks) {
      tail.write(LbpWriter::Space::registers, block.address, block.words);
      for (std::size_t i = 0; i < block.words; ++i) tail.u32(words[next++]);
    }
  };
  put(layout_.writes);
  if (words.size() > usual_words_) put(layout_.rare_writes);
  tail.write(LbpWriter::Space::timers, scratch + 2 * number_words, number_words).u32(number);
  sent_at_ns_[sent_ % kept_times] = port_->now_ns();
  ++(port_->send({tick_.data(), writes_at_ + tail.size()}) ? counts_.sent : counts_.unsent);
}

bool LbpLink::collect(std::span<std::uint32_t> words, Sample& sample) noexcept {
  if (sent_ == 0) return false;
  const std::int64_t until_ns = port_->now_ns() + wait_ns_;
  bool fresh = false;
  sample.forgot = false;
  for (int i = 0; i < takes_max; ++i) {
    const std::size_t got = port_->receive(answer_, until_ns);
    if (got == 0) break;
    if (got != reply_bytes_) {
      ++counts_.short_;
      ++counts_.refused;
      continue;
    }
    const std::size_t end = 2 * number_words + 4 * TickLayout::words(layout_.reads);
    const std::uint32_t number = u32_at(0), written = u32_at(end + 2 * number_words);
    const std::uint64_t behind = static_cast<std::uint32_t>(static_cast<std::uint32_t>(sent_) - number);
    if (number != u32_at(end) || behind >= sent_ || behind >= kept_times) {
      ++counts_.refused;
      continue;
    }
    if (!arrivals_.is_newest(sent_ - behind, counts_)) continue;
    // A request that came twice shows its own number; beyond that a board goes back only when it was off.
    const auto back = static_cast<std::int32_t>(heard_ - written),
               lag = static_cast<std::int32_t>(number - 1 - written);
    sample.forgot = sample.forgot || (heard_ != 0 && (written == 0 || back > static_cast<std::int32_t>(kept_times)));
    if (!sample.forgot && lag > 0) counts_.unheard += static_cast<std::uint32_t>(lag);
    heard_ = number;
    sample.number = number;
    sample.heard = written;
    for (std::size_t k = 0; k < words.size(); ++k) words[k] = u32_at(2 * number_words + 4 * k);
    sample.time_ns = sent_at_ns_[(sent_ - behind) % kept_times];
    if (behind > 0) ++counts_.late;
    fresh = true;
    if (behind == 0) break;
  }
  return fresh;
}

void LbpLink::write_all(std::span<const RegisterWrite> writes) noexcept {
  LbpWriter all(asked_);
  for (const RegisterWrite& one : writes) all.write(LbpWriter::Space::registers, one.address, 1).u32(one.value);
  if (all.ok()) (void)port_->send({asked_.data(), all.size()});
}

}  // namespace kadans::hostmot2
