#include "settings.h"

#include <algorithm>
#include <array>

#include "message.h"
#include "plant/serial/serial_port.h"

namespace kadans::imu {
namespace {

constexpr std::array<const char*, 2> protocol_names{"mtdata2", "mtdata"};

}  // namespace

std::size_t reading_bytes(Protocol protocol) noexcept {
  return message_overhead + (protocol == Protocol::mtdata2 ? mtdata2_bytes : mtdata_bytes);
}

void SerialImuSettings::fields(PlantFields& f) {
  f.string("device", device, "its serial port, such as /dev/serial/by-id/NAME");
  f.integer("baud", baud, {9600, 4'000'000, "Bd"}, "baud rate that it is set to");
  std::string word = protocol_names[static_cast<std::size_t>(protocol)];
  f.string("protocol", word, "mtdata2: Xsens MTi 10, 100 and later; mtdata: MTi and MTx before them");
  f.string("id", id, "its device id, 8 hexadecimal digits: another device is refused (default: any)");
  f.integer("rate_Hz", rate_Hz, {10, 2000, "Hz"}, "readings in a second");
  f.number("delay_s", delay_s, {0, 0.1, "s"},
           "time from a measurement until its message begins: the device's own filters");
  f.number("patience_s", patience_s, {1e-3, 10, "s"}, "time for an answer while it is found and set up");
  if (!f.reading()) return;
  const auto found = std::ranges::find(protocol_names, word);
  if (found == protocol_names.end()) return f.refuse("protocol", "'" + word + "' must be mtdata2 or mtdata");
  protocol = static_cast<Protocol>(found - protocol_names.begin());
  place = f.place("device");
  if (device.empty()) f.refuse("", "names no device");
  const bool digits = id.size() == 8 && id.find_first_not_of("0123456789ABCDEFabcdef") == std::string::npos;
  if (!id.empty() && !digits) f.refuse("id", "'" + id + "' must be 8 hexadecimal digits, such as 037003F8");
  if (protocol == Protocol::mtdata && mtdata_ticks_per_s % rate_Hz != 0)
    f.refuse("rate_Hz", "must divide " + std::to_string(mtdata_ticks_per_s) + ", such as 100 or 200");
  const std::size_t bits = 10 * reading_bytes(protocol) * rate_Hz;
  if (bits > baud)
    f.refuse("rate_Hz", std::to_string(rate_Hz) + " readings of " + std::to_string(reading_bytes(protocol)) +
                            " bytes are " + std::to_string(bits) + " bits in a second, the line has " +
                            std::to_string(baud));
}

std::vector<PlantType::Finding> examine(const SerialImuSettings& settings) {
  std::vector<PlantType::Finding> findings;
  if (settings.given()) examine_serial_port("imu", settings.device, findings);
  return findings;
}

}  // namespace kadans::imu
