#include "port_check.h"

#include <cerrno>
#include <system_error>

#include <sys/stat.h>
#include <unistd.h>

#include "serial_port.h"

namespace kadans::dynamixel {
namespace {

PlantType::Finding device_of(const PortSettings& port) {
  PlantType::Finding finding{.topic = "port " + port.name, .good = false, .is = port.device, .should = {}, .how = {}};
  struct stat is {};
  if (stat(port.device.c_str(), &is) != 0) {
    finding.is += ": " + std::system_category().message(errno);
    finding.should = "a serial port";
    finding.how = "plug the adapter in, and name it as `ls -l /dev/serial/by-id` shows it";
  } else if (!S_ISCHR(is.st_mode)) {
    finding.is += " is no device";
    finding.should = "a serial port";
    finding.how = "name the adapter as `ls -l /dev/serial/by-id` shows it";
  } else if (access(port.device.c_str(), R_OK | W_OK) != 0) {
    finding.is += ": this user may not open it";
    finding.should = "readable and writable";
    finding.how = "sudo usermod -aG dialout $USER, and log in again";
  } else {
    finding.good = true;
  }
  return finding;
}

}  // namespace

std::vector<PlantType::Finding> examine_ports(const DynamixelSettings& settings, std::int64_t control_period_ns,
                                              const std::string& root) {
  std::vector<PlantType::Finding> findings;
  const std::int64_t period_ns = bus_period_ns(settings, control_period_ns);
  for (const PortSettings& port : settings.ports) {
    findings.push_back(device_of(port));
    const int timer_ms = latency_timer_ms(root, port.device);
    if (timer_ms > 0) {
      findings.push_back({.topic = "latency " + port.name,
                          .good = timer_ms <= 1,
                          .is = "the USB adapter keeps bytes back for up to " + std::to_string(timer_ms) + " ms",
                          .should = "1 ms",
                          .how = "a rule for udev: ACTION==\"add\", SUBSYSTEM==\"usb-serial\", "
                                 "ATTR{latency_timer}=\"1\""});
    }
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
