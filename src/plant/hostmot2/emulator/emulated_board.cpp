#include "emulated_board.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace kadans::hostmot2 {
namespace {

constexpr double low_clock_Hz = 100e6, high_clock_Hz = 200e6;
constexpr unsigned idrom_at = 0x400, modules_off = 64, pins_off = 448, idrom_words = 0x200;
constexpr unsigned index_bit = 4, once_bit = 6, probe_bit = 13, clear_bit = 5;
constexpr std::uint32_t control_bits = 0xFFF8;  // that are kept as they are written

bool bit(std::uint32_t word, unsigned number) noexcept { return (word >> number & 1U) != 0; }

std::uint32_t letters(const std::string& text, std::size_t from) {
  std::uint32_t word = 0;
  for (std::size_t i = 0; i < 4; ++i)
    word |= (from + i < text.size() ? static_cast<std::uint32_t>(static_cast<unsigned char>(text[from + i])) : 0U)
            << (8 * i);
  return word;
}

}  // namespace

EmulatedBoard::EmulatedBoard(const Settings& settings) : settings_(settings) {
  if (first_free_pin() > pins() || pins() > 144 || settings.encoders > 32 || settings.pwms > 32)
    throw std::invalid_argument(settings.name + " has " + std::to_string(pins()) + " pins, too few for " +
                                std::to_string(settings.encoders) + " encoders and " + std::to_string(settings.pwms) +
                                " PWMs");
  encoders_.resize(settings.encoders);
  pwms_.resize(settings.pwms);
  ports_.resize(settings.ports);
  inputs_.resize(pins());
  write_idrom();
  power_on();
}

void EmulatedBoard::write_idrom() {
  idrom_.assign(idrom_words, 0);
  const std::string name = "MESA" + settings_.name.substr(0, 4);
  const std::uint32_t head[] = {3,
                                modules_off,
                                pins_off,
                                letters(name, 0),
                                letters(name, 4),
                                9,
                                256,
                                settings_.ports,
                                pins(),
                                settings_.width,
                                static_cast<std::uint32_t>(low_clock_Hz),
                                static_cast<std::uint32_t>(high_clock_Hz),
                                4,
                                64,
                                256,
                                256};
  std::ranges::copy(head, idrom_.begin());
  std::size_t at = modules_off / 4;
  const auto module = [&](unsigned tag, unsigned version, unsigned clock, unsigned count, unsigned base,
                          unsigned registers, unsigned many) {
    idrom_[at++] = tag | version << 8U | clock << 16U | count << 24U;
    idrom_[at++] = base | registers << 16U;
    idrom_[at++] = many;
  };
  module(2, 0, 1, 1, 0x0C00, 3, 0);
  module(3, 0, 1, settings_.ports, 0x1000, 5, 0x1F);
  module(26, 0, 1, 1, 0x7000, 7, 0);  // one that this driver leaves alone
  if (settings_.encoders > 0) module(4, 2, 1, settings_.encoders, 0x3000, 5, 3);
  if (settings_.pwms > 0) module(6, 0, 2, settings_.pwms, 0x4000, 5, 3);
  module(128, 0, 1, 1, 0x0200, 1, 0);
  for (unsigned pin = 0; pin < pins(); ++pin) {
    std::uint32_t use = 3U << 24U;
    if (pin < 3 * settings_.pwms) use |= (pin / 3) << 16U | 6U << 8U | 0x80U | (pin % 3 + 1);
    const unsigned behind = pin - 3 * settings_.pwms;
    if (pin >= 3 * settings_.pwms && pin < first_free_pin()) use |= (behind / 3) << 16U | 4U << 8U | (behind % 3 + 1);
    idrom_[pins_off / 4 + pin] = use;
  }
}

void EmulatedBoard::power_on() noexcept {
  for (Encoder& one : encoders_) one = {.count = one.count, .origin = one.origin, .probe = one.probe};
  for (Pwm& one : pwms_) one = {};
  for (Port& one : ports_) one = {};
  pwm_rate_ = pdm_rate_ = pwm_enable_ = stamp_divisor_ = 0;
  timeout_ = 0x80000000U;
  bitten_ = false;
  left_ns_ = 0;
}

void EmulatedBoard::switch_power() noexcept {
  for (Encoder& one : encoders_) one.origin = one.count;
  power_on();
}

std::uint16_t EmulatedBoard::stamp_clock() const noexcept {
  const double rate = bit(stamp_divisor_, 15) ? low_clock_Hz : low_clock_Hz / ((stamp_divisor_ & 0x7FFFU) + 2);
  return static_cast<std::uint16_t>(static_cast<std::uint64_t>(1e-9 * static_cast<double>(time_ns_) * rate));
}

bool EmulatedBoard::index_at(std::int64_t count) const noexcept {
  const std::int64_t turn = settings_.counts_per_index;
  return ((count % turn) + turn) % turn == 0;
}

// An index or a probe: latches the count where it was asked to.
void EmulatedBoard::edge(Encoder& encoder, bool by_index) noexcept {
  const unsigned by = by_index ? index_bit : probe_bit;
  if (!bit(encoder.control, by)) return;
  const auto count = static_cast<std::uint16_t>(encoder.count - encoder.origin);
  encoder.latched = count;
  if (by_index && bit(encoder.control, clear_bit)) encoder.origin = encoder.count;
  if (bit(encoder.control, once_bit)) encoder.control &= ~((1U << by) | (by_index ? 1U << clear_bit : 0U));
}

void EmulatedBoard::turn_to(unsigned number, std::int64_t count) noexcept {
  Encoder& encoder = encoders_[number];
  if (count == encoder.count) return;
  encoder.stamp = stamp_clock();
  // Past at most one index: joints are slow against the periods in which they are looked at.
  const std::int64_t step = count > encoder.count ? 1 : -1;
  const std::int64_t way = std::min<std::int64_t>(std::abs(count - encoder.count), settings_.counts_per_index);
  const std::int64_t from = count - step * way;
  for (std::int64_t at = from + step, left = way; left > 0; at += step, --left) {
    if (!index_at(at)) continue;
    encoder.count = at;
    edge(encoder, true);
  }
  encoder.count = count;
}

void EmulatedBoard::probe(unsigned number, bool level) noexcept {
  Encoder& encoder = encoders_[number];
  if (encoder.probe == level) return;
  encoder.probe = level;
  if (level == bit(encoder.control, 12)) edge(encoder, false);
}

double EmulatedBoard::duty(const Pwm& pwm) const noexcept {
  const bool pulses = (pwm.mode >> 3U & 3U) == 3;
  if ((pulses ? pdm_rate_ : pwm_rate_) == 0) return 0;
  const unsigned bits = pulses ? 12 : 9 + (pwm.mode & 3U);
  const std::uint32_t value = pwm.value >> 16U & 0xFFFU;
  return std::min(1.0, value / std::exp2(bits));
}

double EmulatedBoard::secondary_level(unsigned pin) const noexcept {
  if (pin >= 3 * settings_.pwms) return 0;  // an encoder's input
  const unsigned number = pin / 3;
  const Pwm& pwm = pwms_[number];
  const bool enabled = bit(pwm_enable_, number), negative = bit(pwm.value, 31);
  const double high = enabled ? duty(pwm) : 0;
  const unsigned kind = pwm.mode >> 3U & 3U;
  switch (pin % 3) {
    case 0:
      if (kind == 1) return negative ? 1 : 0;
      if (kind == 2) return negative ? high : 0;
      return high;
    case 1:
      if (kind == 1) return high;
      if (kind == 2) return negative ? 0 : high;
      return negative ? 1 : 0;
    default:
      return enabled ? 0 : 1;
  }
}

bool EmulatedBoard::driven(unsigned pin) const noexcept {
  const Port& port = ports_[pin / settings_.width];
  return bit(port.direction, pin % settings_.width) && !bit(port.drain, pin % settings_.width);
}

double EmulatedBoard::level(unsigned pin) const noexcept {
  const Port& port = ports_[pin / settings_.width];
  const unsigned at = pin % settings_.width;
  if (!driven(pin)) return 0;
  const double is = bit(port.secondary, at) ? secondary_level(pin) : (bit(port.data, at) ? 1.0 : 0.0);
  return bit(port.inverted, at) ? 1 - is : is;
}

std::uint32_t EmulatedBoard::pin_word(unsigned port) const noexcept {
  std::uint32_t word = 0;
  for (unsigned at = 0; at < settings_.width; ++at) {
    const unsigned pin = port * settings_.width + at;
    const bool high = driven(pin) ? level(pin) > 0.5 : inputs_[pin];
    word |= (high ? 1U : 0U) << at;
  }
  return word;
}

void EmulatedBoard::bite() noexcept {
  bitten_ = true;
  for (Port& port : ports_) port.direction = port.drain = 0;
}

void EmulatedBoard::pass(std::int64_t dt_ns) noexcept {
  time_ns_ += dt_ns;
  if (!watching()) return;
  left_ns_ -= static_cast<double>(dt_ns);
  if (left_ns_ <= 0) bite();
}

bool EmulatedBoard::read(unsigned address, std::uint32_t& value) const noexcept {
  value = 0;
  if (address % 4 != 0 || address > 0xFFFF) return false;
  const unsigned block = address & 0xFF00U, instance = (address & 0xFFU) / 4;
  if (address >= idrom_at && address < idrom_at + 4 * idrom_words) {
    value = idrom_[(address - idrom_at) / 4];
    return true;
  }
  switch (block) {
    case 0x0100:
      if (address == 0x100) value = 0x55AACAFE;
      if (address == 0x104) value = letters("HOSTMOT2", 0);
      if (address == 0x108) value = letters("HOSTMOT2", 4);
      if (address == 0x10C) value = idrom_at;
      return true;
    case 0x0C00:
      value = bit(timeout_, 31) ? timeout_ : static_cast<std::uint32_t>(std::max(0.0, left_ns_ * 1e-9 * low_clock_Hz));
      return true;
    case 0x0D00:
      value = bitten_ ? 1 : 0;
      return true;
    case 0x1000:
      if (instance < ports_.size()) value = pin_word(instance);
      return true;
    case 0x1100:
      if (instance < ports_.size()) value = ports_[instance].direction;
      return true;
    case 0x3000:
      if (instance < encoders_.size()) {
        const Encoder& is = encoders_[instance];
        value = static_cast<std::uint32_t>(is.stamp) << 16U | static_cast<std::uint16_t>(is.count - is.origin);
      }
      return true;
    case 0x3100:
      if (instance < encoders_.size()) {
        const Encoder& is = encoders_[instance];
        const std::uint32_t a = static_cast<std::uint32_t>(is.count >> 1) & 1U;
        const std::uint32_t b = static_cast<std::uint32_t>((is.count + 1) >> 1) & 1U;
        value =
            static_cast<std::uint32_t>(is.latched) << 16U | is.control | (index_at(is.count) ? 4U : 0U) | b << 1U | a;
      }
      return true;
    case 0x3300:
      value = stamp_clock();
      return true;
    default:
      return true;  // what is written there cannot be read, or nothing is there: it reads as 0
  }
}

bool EmulatedBoard::write(unsigned address, std::uint32_t value) noexcept {
  if (address % 4 != 0 || address > 0xFFFF) return false;
  const unsigned block = address & 0xFF00U, instance = (address & 0xFFU) / 4;
  const bool port = instance < ports_.size(), encoder = instance < encoders_.size(), pwm = instance < pwms_.size();
  switch (block) {
    case 0x0C00:
      timeout_ = value;
      left_ns_ = (static_cast<double>(value & 0x7FFFFFFFU) + 1) / low_clock_Hz * 1e9;
      break;
    case 0x0D00:
      if (!bit(value, 0)) bitten_ = false;
      break;
    case 0x0E00:
      if (value >> 24U == 0x5A && !bitten_)
        left_ns_ = (static_cast<double>(timeout_ & 0x7FFFFFFFU) + 1) / low_clock_Hz * 1e9;
      break;
    case 0x1000:
      if (port) ports_[instance].data = value;
      break;
    case 0x1100:
      if (port) ports_[instance].direction = value;
      break;
    case 0x1200:
      if (port) ports_[instance].secondary = value;
      break;
    case 0x1300:
      if (port) ports_[instance].drain = value;
      break;
    case 0x1400:
      if (port) ports_[instance].inverted = value;
      break;
    case 0x3000:
      if (encoder) encoders_[instance].origin = encoders_[instance].count;
      break;
    case 0x3100:
      if (encoder) encoders_[instance].control = value & control_bits;
      break;
    case 0x3200:
      stamp_divisor_ = value & 0xFFFFU;
      break;
    case 0x4000:
      if (pwm) pwms_[instance].value = value;
      break;
    case 0x4100:
      if (pwm) pwms_[instance].mode = value;
      break;
    case 0x4200:
      pwm_rate_ = value & 0xFFFFU;
      break;
    case 0x4300:
      pdm_rate_ = value & 0xFFFFU;
      break;
    case 0x4400:
      pwm_enable_ = value;
      break;
    default:
      break;  // a LED, the filter of encoders, or nothing: no input shows it
  }
  return true;
}

}  // namespace kadans::hostmot2
