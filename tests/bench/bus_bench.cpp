// What a tick of the HostMot2 driver costs, in CPU time of its thread, against a bare sendto and recvfrom of the same
// bytes, in turns. The board answers from another thread, over the loopback, or from the network namespace
// KADANS_BENCH_NETNS at the address KADANS_BENCH_BOARD (tests/project/board_network.sh); each answer is here before it
// is asked for.
#include <array>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <future>
#include <stdexcept>
#include <string>
#include <thread>

#include <fcntl.h>
#include <poll.h>
#include <sched.h>
#include <sys/socket.h>
#include <unistd.h>

#include "plant/hostmot2/emulator/emulated_machine.h"
#include "plant/hostmot2/hostmot2_plant.h"
#include "plant/hostmot2/lbp_link.h"
#include "plant/socket_address.h"
#include "report.h"

namespace kadans::bench {
namespace {

constexpr int bus_rounds = 15, bus_ticks = 400;
std::string of_environment(const char* name, const char* otherwise) {
  const char* const value = std::getenv(name);  // NOLINT(concurrency-mt-unsafe): nobody sets it
  return value != nullptr ? value : otherwise;
}
const std::string board_host = of_environment("KADANS_BENCH_BOARD", "127.0.0.1");
const std::string board_at = board_host + ":27481", echo_at = board_host + ":27482";

// Of this thread alone, from now on.
void enter_namespace() {
  const std::string name = of_environment("KADANS_BENCH_NETNS", "");
  if (name.empty()) return;
  const int space = open(("/run/netns/" + name).c_str(), O_RDONLY | O_CLOEXEC);
  if (space < 0 || setns(space, CLONE_NEWNET) != 0) throw std::runtime_error("no network namespace " + name);
  close(space);
}

double cpu_ns() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e9 * static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec);
}

void wait_readable(int descriptor) {
  pollfd wanted{descriptor, POLLIN, 0};
  (void)poll(&wanted, 1, 100);
}

// A leg: seven encoders and six PWMs.
hostmot2::HostMot2Settings leg_settings() {
  hostmot2::HostMot2Settings settings;
  settings.boards = {{.name = "io", .address = board_at, .card = "7I96"}};
  settings.reply_wait_s = 0.01;
  settings.watchdog_s = 0.5;
  for (std::uint32_t i = 0; i < 7; ++i) {
    hostmot2::DriveWiring drive{
        .drive = "joint" + std::to_string(i), .board = "io", .encoder = i, .counts_per_rad = 10'430};
    if (i < 6) drive.pwm = i;
    if (i < 6) drive.enable = hostmot2::PinSettings{.number = 39 + i};
    drive.amplifier = {.full = 10, .current_max_A = 10, .Nm_per_A = 0.03, .gear = 100};
    settings.drives.push_back(drive);
  }
  return settings;
}

// Answers on a socket until it is told to stop: as the board does, or with `bytes` bytes.
class Answerer {
 public:
  Answerer(const std::string& place, hostmot2::EmulatedWire* wire) : wire_(wire) {
    std::promise<int> listens;
    thread_ = std::thread([this, place, &listens] {
      try {
        enter_namespace();
        listens.set_value(socket_ = listening_socket(place));
      } catch (...) {
        listens.set_exception(std::current_exception());
        return;
      }
      answer();
    });
    try {
      (void)listens.get_future().get();
    } catch (...) {
      thread_.join();
      throw;
    }
  }
  ~Answerer() {
    stop_ = true;
    thread_.join();
    close(socket_);
  }
  std::atomic<std::size_t> bytes{0};
  std::atomic<std::size_t> asked{0};  // bytes of the newest request
  std::atomic<unsigned> replies{0};
  // Until it has answered once more than `before`: on a busy machine its thread waits for its turn.
  void await_reply(unsigned before) const {
    const timespec pause{.tv_sec = 0, .tv_nsec = 200'000};
    for (int i = 0; i < 5000 && replies == before; ++i) nanosleep(&pause, nullptr);
  }

 private:
  void answer() {
    std::array<std::uint8_t, 2048> buffer{};
    while (!stop_) {
      wait_readable(socket_);
      PeerAddress from;
      from.size = sizeof from.address;
      auto* const address = reinterpret_cast<sockaddr*>(&from.address);
      const ssize_t got = recvfrom(socket_, buffer.data(), buffer.size(), MSG_DONTWAIT, address, &from.size);
      if (got < 0) continue;
      asked = static_cast<std::size_t>(got);
      std::vector<std::uint8_t> reply(bytes);
      if (wire_ != nullptr) {
        wire_->receive({buffer.data(), static_cast<std::size_t>(got)}, 0);
        reply = wire_->take(0);
        bytes = reply.empty() ? bytes.load() : reply.size();
      }
      if (!reply.empty()) (void)sendto(socket_, reply.data(), reply.size(), 0, address, from.size);
      ++replies;
    }
  }
  int socket_ = -1;
  hostmot2::EmulatedWire* wire_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace

void bench_bus(Report& report) {
  const hostmot2::HostMot2Settings settings = leg_settings();
  PlantSite site{.file = "bench", .layout = {.robot = "leg"}};
  for (const auto& drive : settings.drives) site.layout.joints.push_back(drive.drive);
  hostmot2::EmulatedMachine machine(settings, site, 1);
  Answerer board(board_at, &machine.wire(0));
  Answerer echo(echo_at, nullptr);
  std::vector<std::unique_ptr<hostmot2::BoardLink>> links;
  links.push_back(std::make_unique<hostmot2::LbpLink>(std::make_unique<hostmot2::UdpPort>(settings.boards.front()),
                                                      50'000'000, 10'000'000));
  hostmot2::HostMot2Plant plant(settings, site, std::move(links));
  (void)plant.open();
  SensorFrame sensors;
  ActuationFrame actuation;
  actuation.joint_count = 7;
  for (auto& joint : actuation.joints) joint = {.effort_Nm = 1, .mode = ActuationMode::effort};
  const int bare = connected_socket(echo_at);
  std::array<std::uint8_t, 2048> out{}, in{};
  std::vector<double> driver_ns, bare_ns;
  for (int round = 0; round < bus_rounds; ++round) {
    double driver = 0, plain = 0;
    for (int i = 0; i < bus_ticks; ++i) {
      const unsigned board_before = board.replies, echo_before = echo.replies;
      double began = cpu_ns();
      plant.write(actuation);
      driver += cpu_ns() - began;
      board.await_reply(board_before);
      began = cpu_ns();
      plant.read(sensors);
      driver += cpu_ns() - began;
      echo.bytes = board.bytes.load();
      began = cpu_ns();
      (void)::sendto(bare, out.data(), board.asked, MSG_DONTWAIT, nullptr, 0);
      plain += cpu_ns() - began;
      echo.await_reply(echo_before);
      wait_readable(bare);  // what it waits for is not counted
      began = cpu_ns();
      while (::recvfrom(bare, in.data(), in.size(), MSG_DONTWAIT, nullptr, nullptr) <= 0) {
      }
      plain += cpu_ns() - began;
    }
    driver_ns.push_back(driver / bus_ticks);
    bare_ns.push_back(plain / bus_ticks);
  }
  close(bare);
  const double driver = median(driver_ns), plain = median(bare_ns);
  report.add("bus.hm2_eth_tick_ns", "hm2-eth, a tick of a board with 7 joints, CPU", driver, "ns");
  report.add("bus.bare_ns", "a bare sendto and recvfrom of the same bytes, CPU", plain, "ns");
  report.add("bus.hm2_eth_share", "hm2-eth against them", driver / plain, "times");
  report.add("bus.request_bytes", "bytes of a request", static_cast<double>(board.asked.load()), "B");
  report.add("bus.reply_bytes", "bytes of a reply", static_cast<double>(board.bytes.load()), "B");
}

}  // namespace kadans::bench
