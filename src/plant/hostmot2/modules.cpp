#include "modules.h"

#include <array>
#include <stdexcept>

namespace kadans::hostmot2 {
namespace {

constexpr std::uint16_t idrom_pointer_at = 0x10C;
constexpr std::size_t modules_max = 48, idrom_pins_max = 144;
constexpr std::uint32_t space_bytes = 0x10000, clock_least_Hz = 1'000'000;

struct NamedTag {
  std::uint8_t tag;
  const char* name;
};
constexpr NamedTag named_tags[] = {
    {2, "watchdog"},       {3, "ioport"}, {4, "encoder"},    {5, "stepgen"},   {6, "pwmgen"},
    {12, "muxed encoder"}, {128, "led"},  {192, "resolver"}, {193, "sserial"}, {26, "phase-locked loop"}};

std::array<std::uint8_t, 4> bytes_of(std::uint32_t word) noexcept {
  return {static_cast<std::uint8_t>(word), static_cast<std::uint8_t>(word >> 8U),
          static_cast<std::uint8_t>(word >> 16U), static_cast<std::uint8_t>(word >> 24U)};
}

[[noreturn]] void fail(const std::string& why) { throw std::runtime_error(why); }

class IdromReader {
 public:
  explicit IdromReader(BoardLink& link) : link_(link) {}
  template <std::size_t N>
  std::array<std::uint32_t, N> words(std::uint32_t address) {
    std::array<std::uint32_t, N> words{};
    if (address + 4 * N > space_bytes || address % 4 != 0) fail("its IDROM points outside of its registers");
    if (!link_.read(static_cast<std::uint16_t>(address), words)) fail("does not answer");
    return words;
  }

 private:
  BoardLink& link_;
};

struct Strides {
  std::array<std::uint16_t, 2> instance{}, registers{};
};

Module module_in(const std::array<std::uint32_t, 3>& words, const Modules& modules, const Strides& strides) {
  const auto head = bytes_of(words[0]), body = bytes_of(words[1]);
  Module one;
  one.tag = head[0];
  one.instances = head[3];
  one.base = static_cast<std::uint16_t>(words[1]);
  one.registers = body[2];
  one.clock_Hz = head[2] == 2 ? modules.clock_high_Hz : modules.clock_low_Hz;
  one.register_stride = strides.registers[body[3] & 1U];
  one.instance_stride = strides.instance[(body[3] >> 4U) & 1U];
  return one;
}

// Whether all its registers lie within the board's.
bool fits(const Module& one) noexcept {
  if (one.instances == 0 || one.registers == 0) return false;
  const std::uint32_t last = one.base + std::uint32_t{one.registers - 1U} * one.register_stride +
                             std::uint32_t{one.instances - 1U} * one.instance_stride;
  return one.base % 4 == 0 && one.register_stride % 4 == 0 && one.instance_stride == 4 && last + 4 <= space_bytes;
}

void take(Modules& modules, const Module& one) {
  const auto known = [&](std::optional<Module>& into, unsigned registers) {
    if (into) fail("has two modules of the kind " + module_name(one.tag));
    if (!fits(one) || one.registers < registers)
      fail("describes its " + module_name(one.tag) + " in a way that cannot be");
    into = one;
  };
  switch (static_cast<ModuleTag>(one.tag)) {
    case ModuleTag::watchdog:
      return known(modules.watchdog, 3);
    case ModuleTag::ioport:
      return known(modules.ioport, 5);
    case ModuleTag::encoder:
      return known(modules.encoder, 5);
    case ModuleTag::pwmgen:
      return known(modules.pwmgen, 5);
    case ModuleTag::led:
      return known(modules.led, 1);
  }
  modules.others.push_back(one);
}

}  // namespace

std::string module_name(std::uint8_t tag) {
  for (const NamedTag& one : named_tags) {
    if (one.tag == tag) return one.name;
  }
  return "module " + std::to_string(tag);
}

std::string Modules::text() const {
  std::string is;
  const auto count = [&](const std::optional<Module>& one) {
    if (one)
      is += (is.empty() ? "" : ", ") + std::to_string(one->instances) + " " + module_name(one->tag) +
            (one->instances == 1 ? "" : "s");
  };
  for (const auto* one : {&ioport, &encoder, &pwmgen, &watchdog}) count(*one);
  for (std::size_t i = 0; i < others.size(); ++i) is += (i == 0 ? "; also there: " : ", ") + module_name(others[i].tag);
  return is;
}

Modules read_modules(BoardLink& link) {
  IdromReader reader(link);
  Modules modules;
  const auto head = reader.words<4>(cookie_at);
  if (head[0] != cookie) fail("is no HostMot2 board: its cookie is wrong");
  if (head[1] != 0x54534F48 || head[2] != 0x32544F4D) fail("is no HostMot2 board: its name is not HOSTMOT2");
  const std::uint32_t at = reader.words<1>(idrom_pointer_at)[0] & 0xFFFFU;
  const auto idrom = reader.words<16>(at);
  if (idrom[0] != 2 && idrom[0] != 3) fail("has an IDROM of type " + std::to_string(idrom[0]) + ", known are 2 and 3");
  for (const std::uint32_t word : {idrom[3], idrom[4]}) {
    for (const std::uint8_t byte : bytes_of(word)) {
      if (byte != 0) modules.board += byte > ' ' && byte < 0x7F ? static_cast<char>(byte) : '?';
    }
  }
  modules.ports = idrom[7];
  modules.port_width = idrom[9];
  modules.clock_low_Hz = idrom[10];
  modules.clock_high_Hz = idrom[11];
  const bool pins_good = modules.ports >= 1 && modules.port_width >= 1 && modules.port_width <= 32 &&
                         modules.ports <= idrom_pins_max / modules.port_width &&
                         idrom[8] == modules.ports * modules.port_width;
  if (!pins_good) fail("describes its pins in a way that cannot be");
  if (modules.clock_low_Hz < clock_least_Hz || modules.clock_high_Hz < clock_least_Hz)
    fail("describes its clocks in a way that cannot be");
  Strides strides;
  for (std::size_t i = 0; i < 2; ++i) {
    strides.instance[i] = static_cast<std::uint16_t>(idrom[12 + i]);
    strides.registers[i] = static_cast<std::uint16_t>(idrom[14 + i]);
  }
  for (std::uint32_t i = 0; i < modules_max; ++i) {
    const auto words = reader.words<3>(at + idrom[1] + 12 * i);
    if ((words[0] & 0xFFU) == 0) break;
    take(modules, module_in(words, modules, strides));
  }
  if (!modules.ioport || modules.ioport->instances != modules.ports) fail("has no ioport for each of its ports");
  if (!modules.watchdog) fail("has no watchdog: its amplifiers would go on when this program dies");
  for (std::uint32_t i = 0; i < modules.ports * modules.port_width; ++i) {
    const auto pin = bytes_of(reader.words<1>(at + idrom[2] + 4 * i)[0]);
    if (pin[3] != static_cast<std::uint8_t>(ModuleTag::ioport)) fail("describes its pins in a way that cannot be");
    modules.pins.push_back({pin[1], static_cast<std::uint8_t>(pin[2] & 0x7FU)});
  }
  return modules;
}

}  // namespace kadans::hostmot2
