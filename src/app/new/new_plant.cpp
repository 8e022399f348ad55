// `kadans new plant`: a type of plant as a plug-in, with the other side of its wire and a test of both. In the
// templates
// @name@ and @Class@ stand for its names. Its bus is datagrams: a working example whose wire the author replaces.
#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "app/terminal.h"
#include "config/json/foreign_json.h"
#include "kadans/signal/shell_word.h"
#include "new_files.h"
#include "new_subject.h"
#include "plant_wire.h"
#include "signal/input_file.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;

struct NewPlantOptions {
  std::string name;
  std::string robot;
  std::string folder = ".";  // the plant's folder is made in this folder
};

constexpr std::string_view plant_header_template =
    R"(// Type of plant "@name@": drives behind a bus. What stands here is a working example whose bus is UDP; replace its wire
// (@name@_wire.h) by that of your drives. docs/hardware.md of Kadans says what a plant must do, and in which order to
// write it.
#pragma once

#include <memory>

#include <kadans/plant/plant_type.h>

std::unique_ptr<kadans::PlantType> make_@name@_type();
)";

constexpr std::string_view plant_source_template = R"(#include "@name@.h"

#include <cerrno>
#include <chrono>
#include <cstring>
#include <string>
#include <thread>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <kadans/plant/plant_type.h>
#include <kadans/signal/input_error.h>

#include "@name@_wire.h"

using namespace kadans;
using namespace @name@_wire;

namespace {

constexpr int datagrams_max = 16;  // in one tick: more than that wait, and a flood of them costs no tick

sockaddr_in address_of(const std::string& place) {
  const std::size_t colon = place.rfind(':');
  sockaddr_in address{};
  address.sin_family = AF_INET;
  const std::string host = colon == std::string::npos ? place : place.substr(0, colon);
  const int port = colon == std::string::npos ? 0 : std::atoi(place.c_str() + colon + 1);
  if (port < 1 || port > 65535 || (!host.empty() && inet_pton(AF_INET, host.c_str(), &address.sin_addr) != 1))
    throw InputError({.message = "'" + place + "' is no place: it must be like 127.0.0.1:7300"});
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  return address;
}

// One socket that never waits in a tick.
class Socket {
 public:
  Socket(const std::string& place, bool listens) : descriptor_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    const sockaddr_in address = address_of(place);
    const auto* const at = reinterpret_cast<const sockaddr*>(&address);
    const int failed = listens ? bind(descriptor_, at, sizeof address) : connect(descriptor_, at, sizeof address);
    if (failed == 0) return;
    const std::string why = std::strerror(errno);
    close(descriptor_);
    throw InputError({.message = place + ": " + why});
  }
  ~Socket() { close(descriptor_); }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;

  void wait(int milliseconds) const noexcept {
    pollfd wanted{descriptor_, POLLIN, 0};
    (void)poll(&wanted, 1, milliseconds);
  }
  // Empty: nothing is there.
  Bytes receive(Buffer& buffer, sockaddr_in* from = nullptr) const noexcept {
    sockaddr_in sender{};
    socklen_t size = sizeof sender;
    const ssize_t got = recvfrom(descriptor_, buffer.data(), buffer.size(), MSG_DONTWAIT,
                                 reinterpret_cast<sockaddr*>(&sender), &size);
    if (from != nullptr) *from = sender;
    return got > 0 ? Bytes(buffer).first(static_cast<std::size_t>(got)) : Bytes();
  }
  bool send(Bytes datagram, const sockaddr_in* to = nullptr) const noexcept {
    return sendto(descriptor_, datagram.data(), datagram.size(), MSG_DONTWAIT | MSG_NOSIGNAL,
                  reinterpret_cast<const sockaddr*>(to), to == nullptr ? 0 : sizeof *to) ==
           static_cast<ssize_t>(datagram.size());
  }

 private:
  int descriptor_;
};

struct Settings {
  std::string peer = "127.0.0.1:7300";
  double connect_timeout_s = 5;
  double watchdog_s = 0.05;
  double silence_s = 2;
};

class @Class@Plant final : public Plant {
 public:
  @Class@Plant(const Settings& settings, PlantSite site)
      : settings_(settings), site_(std::move(site)), socket_(settings_.peer, false) {}

  // Asks the drives who they are, until they answer.
  bool open(bool (*give_up)() noexcept) override {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(settings_.connect_timeout_s);
    while (std::chrono::steady_clock::now() < end) {
      if (give_up != nullptr && give_up()) return false;
      (void)socket_.send(encode(head(Kind::hello), buffer_));
      const auto next = std::chrono::steady_clock::now() + std::chrono::milliseconds(50);
      socket_.wait(50);
      if (take_all()) return true;
      std::this_thread::sleep_until(next);  // where nobody listens the wait is none
    }
    throw InputError({.file = site_.file,
                      .message = "no answer from " + settings_.peer + " that is of a robot with " +
                                 std::to_string(site_.layout.joints.size()) + " joints and " +
                                 std::to_string(site_.layout.feet.size()) +
                                 " feet: is it on, and is plant.@name@.peer, or --peer, where it listens?"});
  }
  void close() noexcept override {
    for (int i = 0; i < 3; ++i) (void)socket_.send(encode(head(Kind::bye), buffer_));  // one of them will come
  }
  std::vector<PlantCount> link_counts() const override {
    return {{"sent", sent_}, {"received", received_}, {"refused", refused_}};
  }

  // A tick without a new datagram repeats the reading with its counts: so the safety layer knows that it is old.
  void read(SensorFrame& sensors) noexcept override {
    (void)take_all();
    sensors = newest_;
  }
  void write(const ActuationFrame& asked) noexcept override {
    if (socket_.send(encode(head(Kind::asked), asked, buffer_))) ++sent_;
  }

 private:
  Head head(Kind kind) noexcept {
    return {.kind = static_cast<std::uint32_t>(kind),
            .joints = static_cast<std::uint32_t>(site_.layout.joints.size()),
            .feet = static_cast<std::uint32_t>(site_.layout.feet.size()),
            .sequence = ++sequence_,
            .answered = last_};
  }
  // Whether something new came; the newest counts.
  bool take_all() noexcept {
    bool fresh = false;
    for (int i = 0; i < datagrams_max; ++i) {
      const Bytes datagram = socket_.receive(buffer_);
      if (datagram.empty()) break;
      Head found;
      const bool good = decode(datagram, static_cast<std::uint32_t>(site_.layout.joints.size()),
                               static_cast<std::uint32_t>(site_.layout.feet.size()), found) &&
                        found.kind == static_cast<std::uint32_t>(Kind::sensors) && found.sequence > last_ &&
                        decode(datagram, found, newest_);
      if (good) last_ = found.sequence;
      ++(good ? received_ : refused_);
      fresh = fresh || good;
    }
    return fresh;
  }

  Settings settings_;
  PlantSite site_;
  Socket socket_;
  Buffer buffer_{};
  SensorFrame newest_;
  std::uint32_t sequence_ = 0, last_ = 0;
  std::uint64_t sent_ = 0, received_ = 0, refused_ = 0;
};

// The other side: what the drives would do, with a model behind it.
class @Class@Emulator final : public PlantEmulator {
 public:
  @Class@Emulator(const Settings& settings, const PlantSite& site, const std::string& listen)
      : settings_(settings), layout_(site.layout), damping_(site.damping_Nms_per_rad), socket_(listen, true) {}

  bool await(int milliseconds) noexcept override {
    peer_ = {};
    last_ = 0;
    silent_ns_ = 0;
    driven_ = released_ = false;
    session_ = {};
    socket_.wait(milliseconds);
    take_all();
    return peer_.sin_port != 0;
  }
  bool beat(World& world, std::uint32_t periods) override {
    WorldRobot& robot = world.robot(0);
    take_all();
    if (session_.left) return false;
    const bool released = driven_ && static_cast<double>(silent_ns_) > 1e9 * settings_.watchdog_s;
    if (released && !released_) ++session_.releases;
    released_ = released;
    for (std::uint32_t i = 0; driven_ && i < periods; ++i) {
      robot.write(released ? damped(robot.truth()) : asked_);
      world.step(layout_.period_ns);
    }
    silent_ns_ += static_cast<std::int64_t>(periods) * layout_.period_ns;
    if (static_cast<double>(silent_ns_) > 1e9 * settings_.silence_s) return false;
    robot.read(sensors_);
    const Head head{.kind = static_cast<std::uint32_t>(Kind::sensors),
                    .joints = joints(),
                    .feet = feet(),
                    .sequence = ++sequence_,
                    .answered = last_};
    if (socket_.send(encode(head, sensors_, buffer_), &peer_)) ++sent_;
    return true;
  }
  std::string peer_name() const override {
    char text[INET_ADDRSTRLEN] = "";
    (void)inet_ntop(AF_INET, &peer_.sin_addr, text, sizeof text);
    return std::string(text) + ":" + std::to_string(ntohs(peer_.sin_port));
  }
  const Session& session() const noexcept override { return session_; }
  std::vector<PlantCount> link_counts() const override {
    return {{"sent", sent_}, {"received", received_}, {"refused", refused_}};
  }

 private:
  std::uint32_t joints() const noexcept { return static_cast<std::uint32_t>(layout_.joints.size()); }
  std::uint32_t feet() const noexcept { return static_cast<std::uint32_t>(layout_.feet.size()); }

  void take_all() noexcept {
    for (int i = 0; i < datagrams_max; ++i) {
      sockaddr_in from{};
      const Bytes datagram = socket_.receive(buffer_, &from);
      if (datagram.empty()) return;
      ++(take(datagram, from) ? received_ : refused_);
    }
  }
  // The first who says hello is the peer, until the session is over.
  bool take(Bytes datagram, const sockaddr_in& from) noexcept {
    Head head;
    if (!decode(datagram, joints(), feet(), head)) return false;
    if (peer_.sin_port == 0 && head.kind == static_cast<std::uint32_t>(Kind::hello)) peer_ = from;
    const bool peer = from.sin_port == peer_.sin_port && from.sin_addr.s_addr == peer_.sin_addr.s_addr;
    if (!peer || head.sequence <= last_) return false;
    if (head.kind == static_cast<std::uint32_t>(Kind::asked)) {
      if (!decode(datagram, head, asked_)) return false;
      driven_ = true;
    }
    last_ = head.sequence;
    silent_ns_ = 0;
    session_.left = head.kind == static_cast<std::uint32_t>(Kind::bye);
    return true;
  }
  // What the drives do by themselves when nobody speaks to them.
  const ActuationFrame& damped(const PlantTruth& truth) noexcept {
    damping_frame_.joint_count = truth.joint_count;
    for (std::size_t i = 0; i < truth.joint_count; ++i)
      damping_frame_.joints[i] = {.effort_Nm = -damping_ * truth.velocity_rad_s[i], .mode = ActuationMode::effort};
    return damping_frame_;
  }

  Settings settings_;
  PlantLayout layout_;
  double damping_;
  Socket socket_;
  Buffer buffer_{};
  sockaddr_in peer_{};
  ActuationFrame asked_, damping_frame_;
  SensorFrame sensors_;
  Session session_;
  std::int64_t silent_ns_ = 0;
  std::uint32_t sequence_ = 0, last_ = 0;
  bool driven_ = false, released_ = false;
  std::uint64_t sent_ = 0, received_ = 0, refused_ = 0;
};

class @Class@Type final : public PlantType {
 public:
  std::string_view name() const noexcept override { return "@name@"; }
  std::string_view doc() const noexcept override { return "drives behind datagrams"; }
  bool has_fields() const noexcept override { return true; }
  void fields(PlantFields& f) override {
    f.string("peer", settings_.peer, "HOST:PORT of the drives");
    f.number("connect_timeout_s", settings_.connect_timeout_s, {0.1, 600, "s"}, "time to wait for their first answer");
    f.number("watchdog_s", settings_.watchdog_s, {1e-3, 10, "s"}, "time without a word after which the drives let go");
  }
  std::unique_ptr<Plant> make_plant(const PlantSite& site) const override {
    Settings settings = settings_;
    if (!site.peer.empty()) settings.peer = site.peer;
    return std::make_unique<@Class@Plant>(settings, site);
  }
  bool has_imu() const noexcept override { return true; }
  bool is_protocol() const noexcept override { return true; }
  std::unique_ptr<PlantEmulator> make_emulator(const PlantSite& site, const std::string& listen) const override {
    return std::make_unique<@Class@Emulator>(settings_, site, listen);
  }

 private:
  Settings settings_;
};

}  // namespace

std::unique_ptr<PlantType> make_@name@_type() { return std::make_unique<@Class@Type>(); }
)";

constexpr std::string_view plant_test_template =
    R"(// Both sides on the real wire, with an ideal model behind the emulator.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include "@name@.h"

#include <unistd.h>

#include <kadans/plant/ideal_world.h>
#include <kadans/testing/doctest.h>

#include "@name@_wire.h"

using namespace kadans;
using namespace @name@_wire;

namespace {

RobotModel two_joints() {
  RobotModel model;
  model.name = "two";
  model.links.resize(3);
  for (const char* name : {"first", "second"}) {
    Joint joint;
    joint.name = name;
    joint.parent = model.joints.size();
    joint.lower_rad = -2;
    joint.upper_rad = 2;
    joint.effort_max_Nm = 10;
    joint.velocity_max_rad_s = 10;
    model.joints.push_back(joint);
  }
  return model;
}

// Plant and emulator, a tick of each in turn.
struct Bench {
  Bench() {
    settings.drives.resize(2);
    settings.encoders.resize(2);
    settings.position_rad = {0.1, -0.2};
    world.emplace(model, settings);
    site.layout = {.robot = "two", .joints = model.joint_names(), .feet = {}, .sensors = {}};
    // A place of this process's own.
    site.peer = "127.0.0.1:" + std::to_string(20000 + getpid() % 20000);
    emulator = type->make_emulator(site, site.peer);
    plant = type->make_plant(site);
  }
  void open() {
    active = this;
    REQUIRE(plant->open([]() noexcept { return active->serve(), false; }));
  }
  void serve() noexcept {
    if (!session) session = emulator->await(0);
    if (session) session = emulator->beat(*world, 1);
  }
  void tick(const ActuationFrame& asked) {
    plant->read(sensors);
    plant->write(asked);
    serve();
  }

  static inline Bench* active = nullptr;
  RobotModel model = two_joints();
  PlantSettings settings;
  std::optional<IdealWorld> world;
  PlantSite site;
  std::unique_ptr<PlantType> type = make_@name@_type();
  std::unique_ptr<PlantEmulator> emulator;
  std::unique_ptr<Plant> plant;
  SensorFrame sensors;
  bool session = false;
};

ActuationFrame lead(double first_rad, double second_rad) {
  ActuationFrame asked;
  asked.joint_count = 2;
  asked.joints[0] = {.position_rad = first_rad, .mode = ActuationMode::position};
  asked.joints[1] = {.position_rad = second_rad, .mode = ActuationMode::position};
  return asked;
}

}  // namespace

TEST_CASE("The plant finds its drives, leads their joints, and reads where they are") {
  Bench bench;
  bench.open();
  bench.tick(lead(0.1, -0.2));
  CHECK(bench.sensors.joint_count == 2);
  CHECK(bench.sensors.joints[1].position_rad == doctest::Approx(-0.2));
  const std::uint32_t before = bench.sensors.joints[0].sequence;
  for (int i = 0; i < 5; ++i) bench.tick(lead(0.5, -0.6));
  CHECK(bench.sensors.joints[0].position_rad == doctest::Approx(0.5));
  CHECK(bench.sensors.joints[1].position_rad == doctest::Approx(-0.6));
  CHECK(bench.sensors.joints[0].sequence > before);
}

TEST_CASE("A reading that is not new keeps its count, and drives that hear nothing let go") {
  Bench bench;
  bench.open();
  for (int i = 0; i < 3; ++i) bench.tick(lead(0.5, 0));
  bench.plant->read(bench.sensors);
  const std::uint32_t count = bench.sensors.joints[0].sequence;
  bench.plant->read(bench.sensors);
  CHECK(bench.sensors.joints[0].sequence == count);
  for (int i = 0; i < 200; ++i) bench.serve();
  CHECK(bench.emulator->session().releases == 1);
}

TEST_CASE("A tick of the plant does not allocate") {
  Bench bench;
  bench.open();
  bench.tick(lead(0.1, 0));
  const ActuationFrame asked = lead(0.2, 0);
  const testing::AllocationCount heap;
  bench.plant->read(bench.sensors);
  bench.plant->write(asked);
  const long allocations = heap.count();
  CHECK(allocations == 0);
}

TEST_CASE("A datagram that is cut short, of another robot, or holds what is no number does not count") {
  Buffer buffer;
  ActuationFrame asked = lead(0.1, 0.2), read;
  Head head{.kind = static_cast<std::uint32_t>(Kind::asked), .joints = 2, .sequence = 7}, found;
  const Bytes good = encode(head, asked, buffer);
  REQUIRE(decode(good, 2, 0, found));
  REQUIRE(decode(good, found, read));
  CHECK(found.sequence == 7);
  CHECK(read.joints[1].position_rad == 0.2);
  for (std::size_t size = 0; size < good.size(); ++size) CHECK_FALSE(decode(good.first(size), 2, 0, found));
  CHECK_FALSE(decode(good, 3, 0, found));
  asked.joints[0].position_rad = std::numeric_limits<double>::quiet_NaN();
  const Bytes bad = encode(head, asked, buffer);
  REQUIRE(decode(bad, 2, 0, found));
  CHECK_FALSE(decode(bad, found, read));
  CHECK(read.joints[1].position_rad == 0.2);
}
)";

constexpr std::string_view plant_plugin_template =
    R"(// "@name@" as a plug-in: name @name@.so under "plugins" in the robot's configuration.
#include <kadans/control/plugin.h>

#include "@name@.h"

KADANS_PLUGIN(kadans::plugin_type<make_@name@_type>())
)";

constexpr std::string_view plant_cmake_template = R"(cmake_minimum_required(VERSION 3.25)
project(@name@ LANGUAGES CXX)
if(NOT TARGET kadans::kadans)
  find_package(kadans 0.2 REQUIRED)
endif()
enable_testing()

kadans_plugin(@name@ SOURCES plugin.cpp @name@.cpp @name@_wire.cpp LINKS kadans::plant)

add_executable(@name@_test @name@.cpp @name@_wire.cpp @name@_test.cpp)
target_link_libraries(@name@_test PRIVATE kadans::testing kadans::plant_ideal kadans::plant)
add_test(NAME @name@ COMMAND @name@_test)
)";

int run_new_plant(const NewPlantOptions& options) {
  refuse_bad_name(options.name, "a type of plant", "can_drives");
  const NewSubject subject = read_subject({.robot = options.robot});
  const std::string& name = options.name;
  for (const std::string& known : plant_type_names(subject.robot.config.plant_types)) {
    if (known == name) refuse("'" + name + "': there is such a type of plant already");
  }
  const std::vector<std::pair<std::string, std::string>> names{{"@name@", name}, {"@Class@", class_name_of(name)}};
  const fs::path folder = fs::path(options.folder) / name;
  const fs::path robot = subject.file().parent_path() / (name + ".json");
  const std::string library = (fs::weakly_canonical(fs::absolute(folder)) / "build" / (name + ".so"))
                                  .lexically_relative(fs::weakly_canonical(robot.parent_path()))
                                  .string();
  std::vector<std::string> plugins;  // a list takes the place of that of the base
  for (const PlacedName& plugin : subject.robot.config.plugins) plugins.push_back(plugin.name);
  plugins.push_back(library.starts_with("../") ? library : "./" + library);
  const nlohmann::ordered_json driven{{"doc", "Driven through " + name + "."},
                                      {"based_on", subject.robot_file},
                                      {"plugins", plugins},
                                      {"plant", {{name, {{"peer", "127.0.0.1:7300"}}}}}};
  const auto file = [&](const std::string& file_name, std::string_view text) {
    return NewFile{folder / file_name, filled_template(text, names)};
  };
  write_new_files({folder, robot}, {file(name + ".h", plant_header_template),
                                    file(name + "_wire.h", wire_header_template),
                                    file(name + "_wire.cpp", wire_source_template),
                                    file(name + ".cpp", plant_source_template),
                                    file(name + "_test.cpp", plant_test_template),
                                    file("plugin.cpp", plant_plugin_template),
                                    file("CMakeLists.txt", plant_cmake_template),
                                    {fs::proximate(robot), json_text(driven, 2) + "\n"}});
  tell_build(folder, name);
  const std::string shown = shell_word(fs::proximate(robot, subject.project).string());
  tell_command("Serve its drives", subject.project, "plant " + shown + " --as " + name + " --listen 127.0.0.1:7300");
  tell_command("Drive them      ", subject.project, "run " + shown + " --plant " + name);
  return exit_passed;
}

}  // namespace

void add_new_plant(CLI::App& made, CommandLine& line) {
  const auto [plant, options] = line.add<NewPlantOptions>(
      made, "plant", "Write a type of plant as a plug-in: drives behind a bus, their emulator, a test and build files",
      run_new_plant);
  plant->add_option("name", options.name, "Name of the type, for example can_drives")->required()->type_name("NAME");
  plant->add_option("--robot", options.robot, "Robot that it drives (default: the project's only one)")
      ->type_name("FILE");
  plant->add_option("--in", options.folder, "Folder in which its folder is created (default: this one)")
      ->type_name("FOLDER");
}

}  // namespace kadans
