#include "port_check.h"

#include <cerrno>
#include <system_error>

#include <sys/stat.h>
#include <unistd.h>

#include "serial_port.h"

namespace kadans {

void examine_serial_port(const std::string& name, const std::string& device, const std::string& root,
                         std::vector<PlantType::Finding>& findings) {
  PlantType::Finding finding{.topic = "port " + name, .good = false, .is = device, .should = {}, .how = {}};
  struct stat is {};
  if (stat(device.c_str(), &is) != 0) {
    finding.is += ": " + std::system_category().message(errno);
    finding.should = "a serial port";
    finding.how = "plug the adapter in, and name it as `ls -l /dev/serial/by-id` shows it";
  } else if (!S_ISCHR(is.st_mode)) {
    finding.is += " is no device";
    finding.should = "a serial port";
    finding.how = "name the adapter as `ls -l /dev/serial/by-id` shows it";
  } else if (access(device.c_str(), R_OK | W_OK) != 0) {
    finding.is += ": this user may not open it";
    finding.should = "readable and writable";
    finding.how = "sudo usermod -aG dialout $USER, and log in again";
  } else {
    finding.good = true;
  }
  findings.push_back(finding);
  const int timer_ms = latency_timer_ms(root, device);
  if (timer_ms <= 0) return;
  findings.push_back({.topic = "latency " + name,
                      .good = timer_ms <= 1,
                      .is = "the USB adapter keeps bytes back for up to " + std::to_string(timer_ms) + " ms",
                      .should = "1 ms",
                      .how = "a rule for udev: ACTION==\"add\", SUBSYSTEM==\"usb-serial\", "
                             "ATTR{latency_timer}=\"1\""});
}

}  // namespace kadans
