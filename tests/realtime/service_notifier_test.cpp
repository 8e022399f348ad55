#include "realtime/machine/service_notifier.h"

#include <array>
#include <cstring>
#include <filesystem>

#include <doctest/doctest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

using namespace kadans;

namespace {

// What systemd has at the other end.
class Service {
 public:
  Service() : path_(std::filesystem::temp_directory_path() / ("kadans_notify_" + std::to_string(getpid()))) {
    std::filesystem::remove(path_);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strncpy(address.sun_path, path_.c_str(), sizeof address.sun_path - 1);
    file_ = socket(AF_UNIX, SOCK_DGRAM, 0);
    REQUIRE(bind(file_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0);
  }
  ~Service() {
    close(file_);
    std::filesystem::remove(path_);
  }
  Service(const Service&) = delete;
  Service& operator=(const Service&) = delete;

  std::string path() const { return path_.string(); }
  std::string told() const {  // "" when nothing came
    std::array<char, 256> text{};
    const ssize_t size = recv(file_, text.data(), text.size(), MSG_DONTWAIT);
    return {text.data(), size > 0 ? static_cast<std::size_t>(size) : 0};
  }

 private:
  std::filesystem::path path_;
  int file_ = -1;
};

}  // namespace

TEST_CASE("The watchdog is fed only when the control tick has advanced") {
  const Service service;
  ServiceNotifier notifier(service.path());
  REQUIRE(notifier.connected());
  notifier.ready("squats");
  CHECK(service.told() == "READY=1\nSTATUS=squats");
  notifier.alive(0);
  CHECK(service.told().empty());
  notifier.alive(10);
  CHECK(service.told() == "WATCHDOG=1");
  notifier.alive(10);
  CHECK(service.told().empty());
  notifier.alive(11);
  CHECK(service.told() == "WATCHDOG=1");
  notifier.stopping();
  CHECK(service.told() == "STOPPING=1");
}

TEST_CASE("Without a service manager, or with one that is gone, nothing happens") {
  for (const std::string& socket : {std::string(), std::string("/nonexistent/notify"), std::string(300, 'x')}) {
    ServiceNotifier notifier(socket);
    CHECK_FALSE(notifier.connected());
    notifier.ready("");
    notifier.alive(1);
  }
}
