#include "port_check.h"

#include "plant/serial/port_check.h"

namespace kadans::dynamixel {

std::vector<PlantType::Finding> examine_ports(const DynamixelSettings& settings, std::int64_t control_period_ns,
                                              const std::string& root) {
  std::vector<PlantType::Finding> findings;
  const std::int64_t period_ns = bus_period_ns(settings, control_period_ns);
  for (const PortSettings& port : settings.ports) {
    examine_serial_port(port.name, port.device, root, findings);
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
