// Another program in a DDS domain: takes what a run publishes, sends it orders, floods it with rubbish. Told by its
// arguments what to do, in their order:
//
//   ros2_peer DOMAIN (send JSON | event NAME[=VALUE] | twist X,Y,TURN | until SECONDS | flood COUNT | datagrams
//   COUNT)...
//
// What it takes goes to stdout, a JSON object a line. Exit code 1 after a minute of waiting for something.
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include <arpa/inet.h>
#include <dds/dds.h>
#include <nlohmann/json.hpp>
#include <sys/socket.h>
#include <unistd.h>

#include "messages.h"

namespace {

using Json = nlohmann::json;

constexpr dds_duration_t patience_ns = 60'000'000'000;

constexpr const char* loopback = R"(<CycloneDDS><Domain Id="any">
<General><Interfaces><NetworkInterface address="127.0.0.1" multicast="false"/></Interfaces><AllowMulticast>false</AllowMulticast></General>
<Discovery><ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>32</MaxAutoParticipantIndex>
<Peers><Peer address="127.0.0.1"/></Peers></Discovery></Domain></CycloneDDS>)";

dds_entity_t checked(dds_entity_t entity, const char* what) {
  if (entity >= 0) return entity;
  std::fprintf(stderr, "ros2_peer: %s: %s\n", what, dds_strretcode(entity));
  std::exit(2);  // NOLINT(concurrency-mt-unsafe): as it is
}

std::int64_t ns_of(const builtin_interfaces_msg_dds__Time_& time) {
  return std::int64_t{time.sec} * 1'000'000'000 + time.nanosec;
}

template <typename Sequence>
Json numbers(const Sequence& sequence) {
  return std::vector<double>(sequence._buffer, sequence._buffer + sequence._length);
}

Json json_of(const sensor_msgs_msg_dds__JointState_& m) {
  return {{"topic", "joint_states"},
          {"time_ns", ns_of(m.header.stamp)},
          {"frame", m.header.frame_id},
          {"name", std::vector<std::string>(m.name._buffer, m.name._buffer + m.name._length)},
          {"position", numbers(m.position)},
          {"velocity", numbers(m.velocity)},
          {"effort", numbers(m.effort)}};
}

Json json_of(const tf2_msgs_msg_dds__TFMessage_& m) {
  Json frames = Json::array();
  for (std::uint32_t i = 0; i < m.transforms._length; ++i) {
    const geometry_msgs_msg_dds__TransformStamped_& t = m.transforms._buffer[i];
    const auto& [at, turned] = t.transform;
    frames.push_back({{"parent", t.header.frame_id},
                      {"child", t.child_frame_id},
                      {"time_ns", ns_of(t.header.stamp)},
                      {"position", {at.x, at.y, at.z}},
                      {"orientation", {turned.w, turned.x, turned.y, turned.z}}});
  }
  return {{"topic", "tf"}, {"frames", frames}};
}

Json json_of(const sensor_msgs_msg_dds__Imu_& m) {
  return {{"topic", "imu"},
          {"time_ns", ns_of(m.header.stamp)},
          {"frame", m.header.frame_id},
          {"orientation", {m.orientation.w, m.orientation.x, m.orientation.y, m.orientation.z}},
          {"rate", {m.angular_velocity.x, m.angular_velocity.y, m.angular_velocity.z}},
          {"acceleration", {m.linear_acceleration.x, m.linear_acceleration.y, m.linear_acceleration.z}},
          {"covariance",
           {m.orientation_covariance[0], m.angular_velocity_covariance[0], m.linear_acceleration_covariance[0]}}};
}

Json json_of(const rosgraph_msgs_msg_dds__Clock_& m) { return {{"topic", "clock"}, {"time_ns", ns_of(m.clock_time)}}; }

Json json_of(const nav_msgs_msg_dds__Odometry_& m) {
  const auto& [at, turned] = m.pose.pose;
  return {{"topic", "odom"},
          {"time_ns", ns_of(m.header.stamp)},
          {"frame", m.header.frame_id},
          {"child", m.child_frame_id},
          {"position", {at.x, at.y, at.z}},
          {"orientation", {turned.w, turned.x, turned.y, turned.z}},
          {"velocity", {m.twist.twist.linear.x, m.twist.twist.linear.y, m.twist.twist.angular.z}}};
}

class Peer {
 public:
  explicit Peer(std::uint32_t domain) : number_(domain) {
    dds_set_log_sink([](void*, const dds_log_data_t*) {}, nullptr);  // its own rubbish reaches it too
    checked(dds_create_domain(domain, loopback), "no domain");
    participant_ = checked(dds_create_participant(domain, nullptr, nullptr), "no participant");
    waitset_ = checked(dds_create_waitset(participant_), "no waitset");
    // The run learns of the readers in this order: who has joint states is known to have results, too.
    results_ = reader(std_msgs_msg_dds__String__desc, "rt/kadans/command_result", false);
    description_ = reader(std_msgs_msg_dds__String__desc, "rt/robot_description", true);
    active_ = reader(std_msgs_msg_dds__String__desc, "rt/kadans/active", true);
    tf_ = reader(tf2_msgs_msg_dds__TFMessage__desc, "rt/tf", false);
    odom_ = reader(nav_msgs_msg_dds__Odometry__desc, "rt/odom", false);
    imu_ = reader(sensor_msgs_msg_dds__Imu__desc, "rt/imu", false);
    clock_ = reader(rosgraph_msgs_msg_dds__Clock__desc, "rt/clock", false);
    joint_states_ = reader(sensor_msgs_msg_dds__JointState__desc, "rt/joint_states", false);
    commands_ = writer("rt/kadans/command");
    checked(dds_set_status_mask(commands_, DDS_PUBLICATION_MATCHED_STATUS), "no status");
    checked(dds_waitset_attach(waitset_, commands_, 0), "not attached");
  }
  ~Peer() { (void)dds_delete(participant_); }
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;

  void meet() {
    wait_until([this] {
      dds_publication_matched_status_t status{};
      (void)dds_get_publication_matched_status(commands_, &status);
      return status.current_count > 0 && newest_ns_ >= 0;
    });
  }

  void send(const std::string& json) {
    write(json);
    const Json id = Json::parse(json).at("id");
    wait_until([&] { return answered_ == id; });
  }

  // On the event's topic, with the type of the value; waits for the answer.
  void event(const std::string& what) {
    const std::string name = what.substr(0, what.find('=')),
                      value = what.substr(std::min(name.size() + 1, what.size()));
    const bool flag = value == "true" || value == "false",
               number = !value.empty() && value.find_first_not_of("-.0123456789") == std::string::npos;
    const dds_topic_descriptor_t& type = value.empty() ? std_msgs_msg_dds__Empty__desc
                                         : flag        ? std_msgs_msg_dds__Bool__desc
                                         : number      ? std_msgs_msg_dds__Float64__desc
                                                       : std_msgs_msg_dds__String__desc;
    const dds_entity_t to = writer(("rt/kadans/event/" + name).c_str(), type);
    const std_msgs_msg_dds__Empty_ empty{};
    const std_msgs_msg_dds__Bool_ truth{value == "true"};
    const std_msgs_msg_dds__Float64_ real{number ? std::stod(value) : 0};
    const std_msgs_msg_dds__String_ text{const_cast<char*>(value.c_str())};
    const void* sample = &text;
    if (value.empty()) sample = &empty;
    if (flag) sample = &truth;
    if (number) sample = &real;
    emit(to, sample);
  }

  // As a node of ROS 2 drives a robot; waits for the answer.
  void twist(const std::string& what) {
    geometry_msgs_msg_dds__Twist_ wanted{};
    std::istringstream numbers(what);
    std::string one;
    for (double* number : {&wanted.linear.x, &wanted.linear.y, &wanted.angular.z})
      if (std::getline(numbers, one, ',')) *number = std::stod(one);
    emit(writer("rt/cmd_vel", geometry_msgs_msg_dds__Twist__desc), &wanted);
  }

  void until(double seconds) {
    wait_until([&] { return static_cast<double>(newest_ns_) >= 1e9 * seconds && described_; });
  }

  void flood(int count) {
    const std::array<std::string, 10> rubbish{"",
                                              "{",
                                              "[]",
                                              "\xff\xfe\x01",
                                              R"({"verb": 7})",
                                              R"({"verb": "play", "text": {}})",
                                              R"({"id": 1e999, "verb": "estop"})",
                                              R"({"id": {"verb": "estop"}, "verb": "dance"})",
                                              std::string(8000, '['),
                                              std::string(1'000'000, 'x')};
    for (int i = 0; i < count; ++i) write(rubbish[static_cast<std::size_t>(i) % rubbish.size()]);
    const std::string endless(5'000'000, 'y');  // more than is put together: this writer is heard no more
    write(endless);
  }

  // To whoever listens on the first ports of the domain.
  void datagrams(int count) const {
    const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    std::uint32_t random = 1;
    for (int i = 0; i < count; ++i) {
      std::array<unsigned char, 200> bytes{'R', 'T', 'P', 'S', 2, 1};
      for (std::size_t at = i % 2 == 0 ? 6 : 0; at < bytes.size(); ++at)
        bytes[at] = static_cast<unsigned char>((random = random * 1664525 + 1013904223) >> 24U);
      sockaddr_in to{};
      to.sin_family = AF_INET;
      to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
      to.sin_port = htons(static_cast<std::uint16_t>(7400 + 250 * number_ + 10 + static_cast<unsigned>(i) % 4));
      (void)sendto(socket, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&to), sizeof to);
    }
    close(socket);
  }

 private:
  using Quality = std::unique_ptr<dds_qos_t, decltype(&dds_delete_qos)>;

  dds_entity_t reader(const dds_topic_descriptor_t& type, const char* name, bool late) {
    const dds_entity_t made =
        checked(dds_create_reader(participant_, topic(type, name), quality(late).get(), nullptr), name);
    checked(dds_waitset_attach(waitset_, checked(dds_create_readcondition(made, DDS_ANY_STATE), name), made), name);
    return made;
  }
  dds_entity_t writer(const char* name, const dds_topic_descriptor_t& type = std_msgs_msg_dds__String__desc) {
    return checked(dds_create_writer(participant_, topic(type, name), quality(false).get(), nullptr), name);
  }
  dds_entity_t topic(const dds_topic_descriptor_t& type, const char* name) const {
    return checked(dds_create_topic(participant_, &type, name, nullptr, nullptr), name);
  }
  static Quality quality(bool late) {
    Quality qos(dds_create_qos(), &dds_delete_qos);
    dds_qset_reliability(qos.get(), DDS_RELIABILITY_RELIABLE, 1'000'000'000);
    dds_qset_durability(qos.get(), late ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
    dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, 100);
    return qos;
  }

  // When somebody reads it; waits for the answer.
  void emit(dds_entity_t to, const void* sample) {
    checked(dds_set_status_mask(to, DDS_PUBLICATION_MATCHED_STATUS), "no status");
    checked(dds_waitset_attach(waitset_, to, 0), "not attached");
    wait_until([to] {
      dds_publication_matched_status_t status{};
      (void)dds_get_publication_matched_status(to, &status);
      return status.current_count > 0;
    });
    const int before = emitted_;
    (void)dds_write(to, sample);
    wait_until([&] { return emitted_ > before; });
  }

  void write(const std::string& text) {
    const std_msgs_msg_dds__String_ message{const_cast<char*>(text.c_str())};
    (void)dds_write(commands_, &message);
  }

  template <typename Met>
  void wait_until(Met met) {
    const dds_time_t end = dds_time() + patience_ns;
    while (!met()) {
      if (dds_waitset_wait_until(waitset_, nullptr, 0, end) == 0) checked(DDS_RETCODE_TIMEOUT, "waits in vain");
      dds_publication_matched_status_t seen{};
      (void)dds_get_publication_matched_status(commands_, &seen);
      take_all();
    }
  }

  template <typename Message, typename See>
  void take(dds_entity_t from, See see) {
    for (;;) {
      void* sample = nullptr;
      dds_sample_info_t info{};
      if (dds_take(from, &sample, &info, 1, 1) <= 0) return;
      if (info.valid_data) see(*static_cast<const Message*>(sample));
      (void)dds_return_loan(from, &sample, 1);
    }
  }

  void take_all() {
    const auto say = [](const Json& json) { std::printf("%s\n", json.dump().c_str()); };
    take<tf2_msgs_msg_dds__TFMessage_>(tf_, [&](const auto& m) { say(json_of(m)); });
    take<nav_msgs_msg_dds__Odometry_>(odom_, [&](const auto& m) { say(json_of(m)); });
    take<sensor_msgs_msg_dds__Imu_>(imu_, [&](const auto& m) { say(json_of(m)); });
    take<rosgraph_msgs_msg_dds__Clock_>(clock_, [&](const auto& m) { say(json_of(m)); });
    take<sensor_msgs_msg_dds__JointState_>(joint_states_, [&](const auto& m) {
      say(json_of(m));
      newest_ns_ = ns_of(m.header.stamp);
    });
    take<std_msgs_msg_dds__String_>(description_, [&](const auto& m) {
      say({{"topic", "robot_description"}, {"text", m.data}});
      described_ = true;
    });
    take<std_msgs_msg_dds__String_>(active_, [&](const auto& m) {
      say({{"topic", "active"}, {"told", Json::parse(m.data)}});
    });
    take<std_msgs_msg_dds__String_>(results_, [&](const auto& m) {
      const Json answer = Json::parse(m.data);
      const bool emitted = answer.value("verb", "") == "emit";
      emitted_ += emitted ? 1 : 0;
      if (!answer.contains("id") && !emitted) return;  // to rubbish
      say({{"topic", "command_result"}, {"answer", answer}});
      answered_ = answer.value("id", Json());
    });
  }

  std::uint32_t number_;
  dds_entity_t participant_ = 0, waitset_ = 0, results_ = 0, description_ = 0, active_ = 0, tf_ = 0, imu_ = 0,
               clock_ = 0, joint_states_ = 0, commands_ = 0, odom_ = 0;
  std::int64_t newest_ns_ = -1;
  bool described_ = false;
  int emitted_ = 0;
  Json answered_;
};

}  // namespace

int main(int count, char** arguments) {
  if (count < 4 || count % 2 != 0) return 2;
  Peer peer(static_cast<std::uint32_t>(std::atoi(arguments[1])));
  peer.meet();
  for (int i = 2; i + 1 < count; i += 2) {
    const std::string what = arguments[i], with = arguments[i + 1];
    if (what == "send") peer.send(with);
    if (what == "event") peer.event(with);
    if (what == "twist") peer.twist(with);
    if (what == "until") peer.until(std::stod(with));
    if (what == "flood") peer.flood(std::stoi(with));
    if (what == "datagrams") peer.datagrams(std::stoi(with));
  }
  return 0;
}
