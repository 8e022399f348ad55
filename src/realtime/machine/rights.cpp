#include "rights.h"

#include <sstream>

#include "realtime/machine/system_file.h"

namespace kadans {
namespace {

constexpr unsigned cap_ipc_lock = 14, cap_sys_nice = 23;  // linux/capability.h

// "Max realtime priority     95      95      ": the first number behind the name, the soft limit.
std::uint64_t soft_limit(const std::string& limits, const std::string& name) {
  const auto at = limits.find(name);
  if (at == std::string::npos) return 0;
  std::istringstream line(limits.substr(at + name.size(), 40));
  std::string value;
  line >> value;
  return value == "unlimited" ? UINT64_MAX : number_in(value);
}

std::uint64_t effective_capabilities(const std::string& status) {
  const auto at = status.find("CapEff:");
  if (at == std::string::npos) return 0;
  std::istringstream line(status.substr(at + 7, 40));
  std::uint64_t mask = 0;
  line >> std::hex >> mask;
  return mask;
}

}  // namespace

const char* const how_to_get_priority =
    "in /etc/security/limits.d/kadans.conf: '@realtime - rtprio 95', and log in again; in a unit: LimitRTPRIO=95; or "
    "setcap cap_sys_nice,cap_ipc_lock+ep on the program";
const char* const how_to_lock_memory =
    "in /etc/security/limits.d/kadans.conf: '@realtime - memlock unlimited', and log in again; in a unit: "
    "LimitMEMLOCK=infinity; or setcap cap_sys_nice,cap_ipc_lock+ep on the program";

Rights read_rights(const std::filesystem::path& root) {
  const std::string limits = text_of(root / "proc/self/limits");
  const std::uint64_t capabilities = effective_capabilities(text_of(root / "proc/self/status"));
  return {.any_priority = (capabilities >> cap_sys_nice & 1U) != 0,
          .any_memory = (capabilities >> cap_ipc_lock & 1U) != 0,
          .priority_max = soft_limit(limits, "Max realtime priority"),
          .locked_bytes_max = soft_limit(limits, "Max locked memory")};
}

std::vector<std::string> missing_rights(const Rights& rights, int priority) {
  std::vector<std::string> missing;
  if (!rights.priority(priority)) {
    missing.push_back("real-time priority " + std::to_string(priority) + " (this user may have at most " +
                      std::to_string(rights.priority_max) + "): " + how_to_get_priority);
  }
  if (!rights.memory()) {
    missing.push_back("locking all memory (this user may lock " + std::to_string(rights.locked_bytes_max / 1024) +
                      " kB): " + how_to_lock_memory);
  }
  return missing;
}

}  // namespace kadans
