#include "remote/live_instance.h"

#include <array>
#include <chrono>
#include <cstring>
#include <fstream>
#include <iterator>

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "kadans/signal/input_error.h"

namespace kadans::remote_test {

namespace fs = std::filesystem;

namespace {

constexpr const char* configuration_text = R"({
  // The gains were found on the bench.
  "name": "bench",
  "control": {
    "objects": [
      { "name": "posture", "type": "joint_pid",
        "parameters": { "*.kp_Nm_per_rad": 40, "hip.kd_Nms_per_rad": 4 } },  // both joints
      { "name": "spare", "type": "joint_pid" }
    ]
  }
}
)";

constexpr const char* nod = R"(local k = require 'kadans'
local P = k.params { hold_s = { 0.5, min = 0.1, max = 2, unit = 's', doc = 'how long' } }
return k.behavior 'nod' { initial = 'a', k.state 'a' { { after = P.hold_s, to = 'b' } }, k.final 'b' { outcome = 'done' } }
)";

constexpr const char* waits = R"(local k = require 'kadans'
local P = k.params { level = { 1, min = 0, max = 5, unit = 'm', doc = 'a level' } }
return k.behavior 'wait' { initial = 'a', k.state 'a' { endless = true, during = function() local x = P.level end } }
)";

Instance::Facts facts_of(const Project& project) {
  return {.name = "bench",
          .mode = "test",
          .version = "0",
          .configuration = project.configuration(),
          .root = project.root,
          .folders = {project.configuration(), "bench"},
          .records = project.root};
}

Catalog& with_parameters_by_object(Catalog& catalog) {
  for (ParameterId id = 0; id < catalog.parameters.size(); ++id)
    catalog.objects.at(catalog.parameters.owner(id)).parameters.push_back(id);
  return catalog;
}

}  // namespace

Project::Project() {
  write("config/bench/robot.json", configuration_text);
  write("behaviors/bench/nod.lua", nod);
  write("behaviors/bench/wait.lua", waits);
}

void Project::write(const std::string& file, const std::string& text) const { folder.write(file, text); }

std::string Project::read(const std::string& file) const {
  std::ifstream stream(root / file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

bool Supervisor::beat(const Beat&) {
  instance.publish(status_of(exchange.snapshot.newest(1), record.status()));
  for (Fault fault; safety.log().try_pop(fault);) {
    record.tell(fault);
    instance.tell(fault);  // who hears of it finds it in the record
  }
  return true;
}

LiveInstance::LiveInstance(const CtlServer::Settings& settings)
    : host({.root = project.root, .describe = behaviors_description}, with_parameters_by_object(robot.catalog), log),
      instance(facts_of(project), robot.catalog, robot.safety.emergency_stop()),
      server(std::make_unique<CtlServer>(instance, sockets, settings)) {
  log.add(record_side);
  robot.control.record_to(&control_side);
  robot.script.at = [this](std::int64_t time_ns) {
    behavior_side.beside_tick(time_ns);
    const auto snapshot = robot.exchange->snapshot.read(0);
    host.tick(*snapshot, robot.behaviors.sender());
  };
}

void LiveInstance::start(bool with_behaviors) {
  started_ = true;
  with_behaviors_ = with_behaviors;
  robot.control_thread.start();
  robot.plant_thread.start();
  if (with_behaviors) {
    robot.behavior_thread.start();
  } else {
    robot.behavior_wait->end();
  }
  supervisor_thread.start();
  record_thread.start();
  server->start();
}

LiveInstance::~LiveInstance() {
  server->stop();
  if (!started_) return;
  std::vector<TaskThread*> threads{&robot.control_thread, &robot.plant_thread, &supervisor_thread, &record_thread};
  if (with_behaviors_) threads.push_back(&robot.behavior_thread);
  for (TaskThread* thread : threads) thread->stop();
  for (TaskThread* thread : threads) thread->join();
  (void)record_side.stop();
}

Json LiveInstance::ask(const Json& request, Role role) const {
  RawClient client(socket(role));
  (void)client.send(request.dump() + "\n");
  return Json::parse(client.line().value_or("{\"ok\":false,\"error\":\"closed\"}"));
}

Json LiveInstance::ask_until(const Json& request, bool (*wanted)(const Json&)) const {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  for (;;) {
    Json answer = ask(request);
    if ((answer.value("ok", false) && wanted(answer)) || std::chrono::steady_clock::now() > end) return answer;
  }
}

RawClient::RawClient(const fs::path& path) : socket_(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::strncpy(address.sun_path, path.c_str(), sizeof address.sun_path - 1);
  if (connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) close();
}

RawClient::~RawClient() { close(); }

void RawClient::close() noexcept {
  if (socket_ >= 0) ::close(socket_);
  socket_ = -1;
}

void RawClient::end_of_questions() noexcept { (void)shutdown(socket_, SHUT_WR); }

bool RawClient::send(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (count < 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
  return true;
}

bool RawClient::send_some(std::string_view bytes) {
  return ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT) > 0;
}

std::optional<std::string> RawClient::line() {
  for (;;) {
    if (const std::size_t end = in_.find('\n'); end != std::string::npos) {
      std::string line = in_.substr(0, end);
      in_.erase(0, end + 1);
      return line;
    }
    std::array<char, 65536> bytes;
    const ssize_t count = recv(socket_, bytes.data(), bytes.size(), 0);
    if (count <= 0) return std::nullopt;
    in_.append(bytes.data(), static_cast<std::size_t>(count));
  }
}

}  // namespace kadans::remote_test
