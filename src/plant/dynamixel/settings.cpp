#include "settings.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "kadans/signal/nearest_name.h"
#include "servo_bus.h"
#include "signal/number_text.h"

namespace kadans::dynamixel {
namespace {

constexpr std::uint32_t no_id = id_max + 1;
constexpr std::size_t servos_max = 48;  // of one port: their answer must fit into a packet

void port_fields(PlantFields& entry, PortSettings& port) {
  entry.string("device", port.device, "the serial port, such as /dev/serial/by-id/NAME");
  entry.integer("baud", port.baud, {9600, 10'000'000, "Bd"}, "baud rate that its servos are set to");
  if (!entry.reading()) return;
  port.place = entry.place("device");
  if (!is_word(port.name)) entry.refuse("", "'" + port.name + "' is no name for a port: letters, digits and '_'");
  if (port.device.empty()) entry.refuse("", "port '" + port.name + "' names no device");
  if (std::ranges::find(baud_rates, port.baud) == baud_rates.end()) entry.refuse("baud", unknown_baud(port.baud));
}

}  // namespace

void DynamixelSettings::fields(PlantFields& f) {
  f.map(
      "ports",
      [&](PlantFields& entry, const std::string& key) {
        PortSettings port{.name = key};
        port_fields(entry, port);
        if (entry.reading()) ports.push_back(port);
      },
      "the serial ports, by name");
  const auto check_servo = [&](PlantFields& entry, const ServoSettings& servo, const std::string& model) {
    if (servo.model == nullptr) {
      const std::vector<std::string> known = model_names();
      const std::string near = did_you_mean(model, known);
      entry.refuse("model", "unknown servo model '" + model + "'" + (near.empty() ? ", such as XM430-W350" : near));
    }
    const std::span<const std::string> drives = f.drives();
    if (!drives.empty() && std::ranges::find(drives, servo.drive) == drives.end())
      entry.refuse("", "no drive '" + servo.drive + "'" +
                           did_you_mean(servo.drive, std::vector<std::string>(drives.begin(), drives.end())));
    const auto port = std::ranges::find(ports, servo.port, &PortSettings::name);
    if (port == ports.end())
      return entry.refuse("port", servo.port.empty() ? "names no port, and there are several: " + servo.drive
                                                     : "no port '" + servo.port + "' in plant.dynamixel.ports");
    if (servo.id > id_max) entry.refuse("id", "needs an id of 0..252");
    for (const ServoSettings& other : servos) {
      if (servo.id <= id_max && other.port == servo.port && other.id == servo.id)
        entry.refuse("id", "servo " + std::to_string(servo.id) + " of port '" + servo.port + "' already moves '" +
                               other.drive + "'");
      const bool mixed = servo.model != nullptr && other.model != nullptr && other.port == servo.port &&
                         !(IndirectLayout(*servo.model) == IndirectLayout(*other.model));
      if (mixed)
        return entry.refuse("model", std::string(servo.model->name) + " and " + std::string(other.model->name) +
                                         " have their indirect data at different addresses: they need two ports");
    }
    if (servo.model != nullptr && port->baud > baud_of_code(servo.model->baud_code_max))
      entry.refuse("model", std::string(servo.model->name) + " knows at most " +
                                std::to_string(baud_of_code(servo.model->baud_code_max)) + " baud, its port has " +
                                std::to_string(port->baud));
  };
  f.map(
      "servos",
      [&](PlantFields& entry, const std::string& key) {
        ServoSettings servo{.drive = key, .port = ports.size() == 1 ? ports[0].name : ""};
        std::string model;
        if (entry.reading()) servo.id = no_id;
        entry.string("port", servo.port, "its port (default: the only one)");
        entry.integer("id", servo.id, {0, id_max, ""}, "its id on that port");
        entry.string("model", model, "what it is, such as XM430-W350");
        entry.integer("zero_pulse", servo.zero_pulse, {0, pulses_per_turn - 1, "pulse"},
                      "its position when the drive is at 0");
        entry.boolean("reversed", servo.reversed, "it counts in the opposite direction");
        entry.number("Nm_per_A", servo.Nm_per_A, {0, 1000, "Nm/A"},
                     "its torque constant; 0: its stall torque by its stall current");
        if (!entry.reading()) return;
        servo.model = find_model(model);
        servo.place = entry.place("");
        check_servo(entry, servo, model);
        servos.push_back(servo);
      },
      "the servos, by the names of the drives (those of the joints, where no transmission names others)");
  f.number("period_s", period_s, {0, 1, "s"},
           "period of the bus; 0: the least whole multiple of the control period that all ports can hold");
  f.number("watchdog_s", watchdog_s, {watchdog_unit_s, 127 * watchdog_unit_s, "s"},
           "time of silence on the bus after which the servos stop by themselves, in steps of 0.02 s");
  f.number("usb_latency_s", usb_latency_s, {0, 0.1, "s"}, "longest time for which the USB adapter keeps bytes back");
  f.number("patience_s", patience_s, {1e-3, 1, "s"}, "time for an answer while servos are found and set up");
  if (!f.reading() || (ports.empty() && servos.empty())) return;
  for (const std::string& drive : f.drives()) {
    if (std::ranges::find(servos, drive, &ServoSettings::drive) == servos.end())
      f.refuse("servos", "drive '" + drive + "' has no servo");
  }
  for (const PortSettings& port : ports) {
    const bool used = std::ranges::any_of(servos, [&](const auto& s) { return s.port == port.name && s.model; });
    if (!used) {
      f.refuse("ports", "port '" + port.name + "' has no servo");
      continue;
    }
    const CycleNeed need = cycle_need(*this, port);
    if (need.servos > servos_max)
      f.refuse("ports", "port '" + port.name + "' has " + std::to_string(need.servos) + " servos, at most " +
                            std::to_string(servos_max) + " fit into one answer");
    if (period_s > 0 && need.needed_ns > std::llround(1e9 * period_s))
      f.refuse("period_s", "port '" + port.name + "' cannot hold " + milliseconds(std::llround(1e9 * period_s)) +
                               ": its " + std::to_string(need.servos) + " servos need " + milliseconds(need.needed_ns) +
                               " (" + std::to_string(need.bytes) + " bytes at " + std::to_string(port.baud) +
                               " baud are " + milliseconds(need.wire_ns) +
                               ", the USB adapter keeps them back for up to " +
                               milliseconds(std::llround(1e9 * usb_latency_s)) + ")");
  }
}

std::string milliseconds(std::int64_t ns) { return printed("%.2f ms", 1e-6 * static_cast<double>(ns)); }

CycleNeed cycle_need(const DynamixelSettings& settings, const PortSettings& port) {
  CycleNeed need;
  const ServoModel* model = nullptr;
  for (const ServoSettings& servo : settings.servos) {
    if (servo.port != port.name || servo.model == nullptr) continue;
    model = servo.model;
    ++need.servos;
  }
  if (model == nullptr) throw std::invalid_argument("port '" + port.name + "' has no servos");
  const IndirectLayout layout(*model);
  const std::size_t sync_write = packet_bytes_min + 4 + need.servos * (1 + layout.write_bytes());
  const std::size_t fast_read = packet_bytes_min + 4 + need.servos;
  const std::size_t answer = packet_bytes_min - 2 + need.servos * (layout.read_bytes() + fast_block_overhead);
  need.bytes = sync_write + fast_read + answer;
  need.wire_ns = wire_ns(need.bytes, port.baud);
  need.needed_ns = need.wire_ns + std::llround(1e9 * settings.usb_latency_s);
  return need;
}

std::int64_t bus_period_ns(const DynamixelSettings& settings, std::int64_t control_period_ns) {
  if (settings.period_s > 0) return std::llround(1e9 * settings.period_s);
  std::int64_t needed_ns = 1;
  for (const PortSettings& port : settings.ports) needed_ns = std::max(needed_ns, cycle_need(settings, port).needed_ns);
  return (needed_ns + control_period_ns - 1) / control_period_ns * control_period_ns;
}

std::vector<PlantType::Finding> examine_ports(const DynamixelSettings& settings, std::int64_t control_period_ns) {
  std::vector<PlantType::Finding> findings;
  const std::int64_t period_ns = bus_period_ns(settings, control_period_ns);
  for (const PortSettings& port : settings.ports) {
    examine_serial_port(port.name, port.device, findings);
    const CycleNeed need = cycle_need(settings, port);
    const std::string is = std::to_string(need.servos) + " servos: " + std::to_string(need.bytes) + " bytes at " +
                           std::to_string(port.baud) + " baud are " + milliseconds(need.wire_ns) +
                           ", with the adapter " + milliseconds(need.needed_ns) + "; the bus runs at " +
                           milliseconds(period_ns) + ", the control at " + milliseconds(control_period_ns);
    findings.push_back({.topic = "cycle " + port.name,
                        .good = need.needed_ns <= period_ns,
                        .is = is,
                        .should = "a period that it can hold",
                        .how = "a higher baud rate, a second port, or a longer plant.dynamixel.period_s"});
  }
  return findings;
}

}  // namespace kadans::dynamixel
