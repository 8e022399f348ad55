#include "board.h"

#include <algorithm>
#include <cmath>

namespace kadans::hostmot2 {
namespace {

constexpr std::uint32_t watchdog_pet = 0x5A000000, watchdog_off = 0x80000000;
constexpr std::uint32_t pwm_negative = 0x80000000;
constexpr double stamp_Hz = 2e6, filter_Hz = 25e6, pdm_Hz = 6e6;
constexpr std::uint32_t led_first = 0x80000000, blink_ticks = 500;

std::uint32_t divisor(double clock_Hz, double wanted_Hz) noexcept {
  return static_cast<std::uint32_t>(std::clamp(std::lround(clock_Hz / wanted_Hz) - 2, 0L, 0xFFFFL));
}

std::uint32_t increment(double clock_Hz, double wanted_Hz) noexcept {
  return static_cast<std::uint32_t>(std::clamp(std::lround(wanted_Hz * 65536 / clock_Hz), 1L, 0xFFFFL));
}

}  // namespace

Board::Board(BoardSettings settings, std::unique_ptr<BoardLink> link)
    : settings_(std::move(settings)), link_(std::move(link)) {}

void Board::fail(const InputProblem& place, const std::string& why) const {
  throw InputError(place.with("board '" + settings_.name + "' at " + settings_.where() + " " + why));
}

void Board::check_wiring(const HostMot2Settings& all) const {
  const unsigned encoders = modules_.encoder ? modules_.encoder->instances : 0;
  const unsigned pwms = modules_.pwmgen ? modules_.pwmgen->instances : 0;
  const auto used = [&](const OptionalPin& pin) {
    if (!pin) return;
    if (pin->number >= modules_.pin_count())
      fail(pin->place,
           "has no pin " + std::to_string(pin->number) + ", only 0.." + std::to_string(modules_.pin_count() - 1));
    const PinUse use = modules_.pins[pin->number];
    for (const DriveWiring& drive : all.drives) {
      if (drive.board != settings_.name) continue;
      if (use.is(ModuleTag::encoder, drive.encoder) || (drive.pwm && use.is(ModuleTag::pwmgen, *drive.pwm)))
        fail(pin->place, "has " + module_name(use.tag) + " " + std::to_string(use.unit) + " of drive '" + drive.drive +
                             "' on pin " + std::to_string(pin->number) + ": choose another pin");
    }
  };
  for (const DriveWiring& drive : all.drives) {
    if (drive.board != settings_.name) continue;
    if (drive.encoder >= encoders)
      fail(drive.encoder_place,
           "has no encoder " + std::to_string(drive.encoder) + ": its firmware has " + modules_.text());
    if (drive.pwm && *drive.pwm >= pwms)
      fail(drive.pwm_place, "has no pwm " + std::to_string(*drive.pwm) + ": its firmware has " + modules_.text());
    for (const OptionalPin* pin :
         {&drive.enable, &drive.fault, &drive.brake, &drive.low, &drive.high, &drive.home_switch})
      used(*pin);
  }
  for (const FootWiring& foot : all.feet) {
    for (const OptionalPin& pin : foot.corners) {
      if (foot.board == settings_.name) used(pin);
    }
  }
  for (const InputWiring& input : all.inputs) {
    if (input.board == settings_.name) used(input.pin);
  }
  if (all.emergency_board == settings_.name) used(all.emergency);
}

void Board::open(const HostMot2Settings& all) {
  std::string card;
  if (!link_->card_name(card)) {
    const std::string why = link_->why_silent();
    fail(settings_.place, "does not answer: " + (why.empty() ? "is it powered, and is its cable in?" : why));
  }
  if (!card.empty() && card != settings_.card)
    fail(settings_.place, "is a " + card + ", the configuration says " + settings_.card);
  try {
    modules_ = read_modules(*link_);
  } catch (const std::runtime_error& error) {
    fail(settings_.place, error.what());
  }
  if (card.empty() && modules_.board != "MESA" + settings_.card.substr(0, 4))
    fail(settings_.place, "is a " + modules_.board + ", the configuration says " + settings_.card);
  check_wiring(all);
  try {
    lay_out();
  } catch (const std::length_error& error) {
    fail(settings_.place, std::string("is used for too much: ") + error.what());
  }
  list_set_up(all);
  for (std::size_t i = 0; i < armed_from_; ++i) {  // the rest follows with the first tick
    if (!link_->write(set_up_[i])) fail(settings_.place, "stopped answering while it was set up");
  }
}

void Board::lay_out() {
  TickLayout layout;
  std::size_t reads = 0, writes = 0;
  const auto read = [&](std::uint16_t address, unsigned words) {
    layout.reads.push_back({address, static_cast<std::uint16_t>(words)});
    return std::exchange(reads, reads + words);
  };
  const auto write = [&](std::vector<RegisterBlock>& list, std::uint16_t address, unsigned words) {
    list.push_back({address, static_cast<std::uint16_t>(words)});
    return std::exchange(writes, writes + words);
  };
  (void)read(cookie_at, 1);
  status_at_ = read(modules_.watchdog->at(1), 1);
  pins_at_ = read(modules_.ioport->at(0), modules_.ioport->instances);
  if (modules_.encoder) {
    clock_at_ = read(modules_.encoder->at(3), 1);
    counts_at_ = read(modules_.encoder->at(0), modules_.encoder->instances);
    latches_at_ = read(modules_.encoder->at(1), modules_.encoder->instances);
  }
  (void)write(layout.writes, modules_.watchdog->at(2), 1);
  out_pins_at_ = write(layout.writes, modules_.ioport->at(0), modules_.ioport->instances);
  if (modules_.pwmgen) out_pwm_at_ = write(layout.writes, modules_.pwmgen->at(0), modules_.pwmgen->instances);
  if (modules_.led) out_led_at_ = write(layout.writes, modules_.led->at(0), 1);
  usual_words_ = writes;
  if (modules_.encoder) (void)write(layout.rare_writes, modules_.encoder->at(1), modules_.encoder->instances);
  in_.assign(reads, 0);
  fresh_.assign(reads, 0);
  out_.assign(writes, 0);
  out_[0] = watchdog_pet;
  for (std::size_t i = usual_words_; i < writes; ++i) out_[i] = filter;
  link_->lay_out(layout);
}

void Board::list_set_up(const HostMot2Settings& all) {
  const Modules& m = modules_;
  std::vector<std::uint32_t> direction(m.ports), secondary(m.ports);
  const auto set = [&](std::vector<std::uint32_t>& words, std::size_t pin) {
    words[pin / m.port_width] |= 1U << (pin % m.port_width);
  };
  const auto output = [&](const OptionalPin& pin) {
    if (!pin) return;
    set(direction, pin->number);
    set_active(*pin, false);
  };
  std::uint32_t enabled_pwms = 0;
  std::vector<std::uint32_t> modes(m.pwmgen ? m.pwmgen->instances : 0U);
  double rate = 0;
  unsigned bits = 12;
  if (m.pwmgen) {
    while (bits > 9 && settings_.pwm_Hz * std::exp2(bits) > 0.999 * m.pwmgen->clock_Hz) --bits;
    rate = settings_.pwm_Hz * std::exp2(bits);
    pwm_bits_.assign(m.pwmgen->instances, bits);
  }
  for (const DriveWiring& drive : all.drives) {
    if (drive.board != settings_.name) continue;
    output(drive.enable);
    output(drive.brake);
    for (std::size_t pin = 0; pin < m.pins.size(); ++pin) {
      if (drive.pwm && m.pins[pin].is(ModuleTag::pwmgen, *drive.pwm)) set(direction, pin), set(secondary, pin);
    }
    if (!drive.pwm) continue;
    enabled_pwms |= 1U << *drive.pwm;
    const bool pulses = drive.output == PwmOutput::pdm;
    if (pulses) pwm_bits_[*drive.pwm] = 12;
    modes[*drive.pwm] =
        (pwm_bits_[*drive.pwm] - 9) | static_cast<std::uint32_t>(drive.output) << 3U | (pulses ? 0U : 1U << 5U);
  }
  const double timeout = std::clamp(all.watchdog_s * m.clock_low_Hz, 1.0, 0x7FFF0000 * 1.0);
  set_up_ = {{m.watchdog->at(0), watchdog_off}, {m.watchdog->at(1), 0}};
  const auto each_port = [&](unsigned which, const std::vector<std::uint32_t>& words) {
    for (std::uint32_t port = 0; port < m.ports; ++port) set_up_.push_back({m.ioport->at(which, port), words[port]});
  };
  const std::vector<std::uint32_t> none(m.ports);
  each_port(1, none);
  if (m.pwmgen) {
    set_up_.push_back({m.pwmgen->at(4), 0});
    set_up_.push_back({m.pwmgen->at(2), increment(m.pwmgen->clock_Hz, rate)});
    set_up_.push_back({m.pwmgen->at(3), increment(m.pwmgen->clock_Hz, pdm_Hz)});
    for (unsigned i = 0; i < modes.size(); ++i) {
      set_up_.push_back({m.pwmgen->at(0, i), 0});
      set_up_.push_back({m.pwmgen->at(1, i), modes[i]});
    }
    set_up_.push_back({m.pwmgen->at(4), enabled_pwms});
  }
  if (m.encoder) {
    const std::uint32_t by = divisor(m.encoder->clock_Hz, stamp_Hz);
    stamps_per_s_ = m.encoder->clock_Hz / (by + 2.0);
    set_up_.push_back({m.encoder->at(2), by});
    set_up_.push_back({m.encoder->at(4), divisor(m.encoder->clock_Hz, filter_Hz)});
    for (unsigned i = 0; i < m.encoder->instances; ++i) set_up_.push_back({m.encoder->at(1, i), filter});
  }
  each_port(3, none);  // open drain, inverted: no
  each_port(4, none);
  each_port(2, secondary);
  for (std::uint32_t port = 0; port < m.ports; ++port)
    set_up_.push_back({m.ioport->at(0, port), out_[out_pins_at_ + port]});
  armed_from_ = set_up_.size();
  set_up_.push_back({m.watchdog->at(0), static_cast<std::uint32_t>(timeout) - 1});
  set_up_.push_back({m.watchdog->at(2), watchdog_pet});
  each_port(1, direction);
}

void Board::close() noexcept {
  if (set_up_.empty()) return;
  const std::array<RegisterWrite, 1> at_once{{{modules_.watchdog->at(0), 1}}};
  for (int i = 0; i < 3; ++i) link_->write_all(at_once);  // one of them arrives
}

bool Board::collect() noexcept {
  if (!link_->collect(fresh_, sample_) || fresh_[0] != cookie) {
    ++missed_;
    return false;
  }
  missed_ = 0;
  forgot_ = forgot_ || sample_.forgot;
  std::ranges::copy(fresh_, in_.begin());
  const auto since = [&](std::uint32_t number, std::uint32_t of) {
    return static_cast<std::int32_t>(number - of) >= 0;
  };
  bitten_ = (in_[status_at_] & 1U) != 0 && since(sample_.number, repair_number_);
  if (since(sample_.heard, latch_number_)) latch_asked_ = false;
  return true;
}

void Board::send() noexcept {
  ++ticks_;
  if (modules_.led) out_[out_led_at_] = ticks_ / blink_ticks % 2 == 0 ? 0 : led_first;
  // A bitten watchdog that is petted would count again, while its outputs stay off.
  out_[0] = bitten_ ? 0 : watchdog_pet;
  link_->send({out_.data(), latch_asked_ ? out_.size() : usual_words_});
}

void Board::repair() noexcept {
  // In pieces that each fit into a datagram.
  for (std::size_t at = 0; at < set_up_.size();) {
    const std::size_t part = std::min<std::size_t>(100, set_up_.size() - at);
    link_->write_all(std::span(set_up_).subspan(at, part));
    at += part;
  }
  bitten_ = forgot_ = latch_asked_ = false;
  repair_number_ = ticks_ + 1;
}

void Board::set_active(const PinSettings& pin, bool active) noexcept {
  std::uint32_t& word = out_[out_pins_at_ + pin.number / modules_.port_width];
  const std::uint32_t bit = 1U << (pin.number % modules_.port_width);
  word = active != pin.low ? word | bit : word & ~bit;
}

void Board::set_duty(unsigned instance, double duty) noexcept {
  if (!(duty >= -1 && duty <= 1)) duty = 0;
  const auto value = static_cast<std::uint32_t>(std::lround(std::abs(duty) * ((1U << pwm_bits_[instance]) - 1)));
  out_[out_pwm_at_ + instance] = value << 16U | (duty < 0 ? pwm_negative : 0);
}

void Board::write_latch(unsigned instance, std::uint32_t control) noexcept {
  out_[usual_words_ + instance] = control;
  latch_asked_ = true;
  latch_number_ = ticks_ + 1;
}

void Board::arm_latch(unsigned instance, bool for_probe) noexcept {
  write_latch(instance, filter | just_once | (for_probe ? latch_on_probe | probe_high : latch_on_index | index_high));
}

void Board::disarm_latch(unsigned instance) noexcept { write_latch(instance, filter); }

}  // namespace kadans::hostmot2
