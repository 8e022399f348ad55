// `--ros2` as another program of DDS sees it (peer.cpp), in a process of its own and a domain that no other test has.
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>
#include <vector>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "app/program.h"
#include "kadans/model/kinematics.h"
#include "kadans/model/urdf.h"
#include "telemetry/mcap/mcap_reader.h"
#include "telemetry/record/signal_topics.h"

using namespace kadans;
using namespace kadans::program;
using Json = nlohmann::json;
namespace fs = std::filesystem;

namespace {

const std::string program_path = (fs::path(KADANS_BINARY_DIR) / "kadans").string();
const std::string peer_path = (fs::path(KADANS_BINARY_DIR) / "tests/ros2_peer").string();
const std::string domain = std::to_string(own_dds_domain());

// Runs `commands` while `started` goes on in the background; `peer` and `ctl` stand for the programs.
int beside(const fs::path& project, const std::string& started, const std::string& commands) {
  write(project / "beside.sh",
        "unset CYCLONEDDS_URI ROS_DOMAIN_ID\n"
        "export TSAN_OPTIONS=\"suppressions=" KADANS_SOURCE_DIR
        "/tests/app/ros2/tsan_suppressions.txt $TSAN_OPTIONS\"\n"
        "peer() { '" +
            peer_path + "' " + domain +
            " \"$@\"; }\n"
            "ctl() { '" +
            program_path +
            "' ctl --socket c \"$@\"; }\n"
            "'" +
            program_path + "' " + started + " --ctl c --ros2=" + domain +
            " >out 2>err &\n"
            "run=$!\n" +
            commands + "\nkill -TERM $run; wait $run; echo $? >code\n");
  return std::system(("cd '" + project.string() + "' && bash beside.sh >said 2>wrong").c_str());  // NOLINT: the point
}

std::map<std::string, std::vector<Json>> said_by_topic(const fs::path& project) {
  std::map<std::string, std::vector<Json>> topics;
  std::istringstream lines(read(project / "said"));
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with('{')) continue;
    const Json json = Json::parse(line);
    topics[json.at("topic")].push_back(json);
  }
  return topics;
}

// Signals by time and name.
using Rows = std::map<std::int64_t, std::map<std::string, double>>;

std::int64_t time_of(const Json& message) {
  return (message.contains("frames") ? message["frames"][0] : message).at("time_ns").get<std::int64_t>();
}

std::set<std::int64_t> times_of(const std::vector<Json>& messages) {
  std::set<std::int64_t> times;
  for (const Json& message : messages) times.insert(time_of(message));
  return times;
}

// Those of a record at these times.
Rows rows_of(const fs::path& record, const std::set<std::int64_t>& wanted) {
  McapReader reader(record.string());
  Rows rows;
  std::vector<double> values;
  for (McapMessage message; reader.next(message);) {
    const TextMap& metadata = reader.channels().at(message.channel).metadata;
    const auto description = metadata.find("signals");
    if (description == metadata.end() || !wanted.contains(message.time_ns)) continue;
    values.resize((message.payload.size() - cdr_head_bytes) / sizeof(double));
    REQUIRE(read_cdr(message.payload, values) == Precision::full);
    std::istringstream lines(description->second);
    auto value = values.begin();
    for (std::string line; std::getline(lines, line);)
      rows[message.time_ns][line.substr(0, line.find('\t'))] = *value++;
  }
  return rows;
}

Pose pose_of(const Json& frame) { return {frame.at("position").get<Vec3>(), frame.at("orientation").get<Quat>()}; }

// The poses of all frames in the world, by way of their parents.
std::map<std::string, Pose> chained(const Json& frames) {
  std::map<std::string, Pose> poses{{"world", {}}};
  for (std::size_t before = 0; before != poses.size();) {
    before = poses.size();
    for (const Json& frame : frames) {
      const auto parent = poses.find(frame.at("parent").get<std::string>());
      if (parent != poses.end()) poses[frame.at("child").get<std::string>()] = compose(parent->second, pose_of(frame));
    }
  }
  return poses;
}

double apart(const Vec3& a, const Vec3& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

const std::string live = "run config/tulip/robot.json --plant ideal --play squat --threads-on-virtual-time --json";

}  // namespace

TEST_CASE("another process of DDS sees a squatting TULip as its record and Bullet have it") {
  const auto project = project_copy("ros2_squat");
  REQUIRE(beside(project, "sim config/scenarios/squat.json --speed 0.1 --ros2-commands --record seen.mcap --json",
                 "peer send '{\"id\": 1, \"verb\": \"speed\", \"value\": 4}' until 3.5") == 0);
  CHECK_MESSAGE(read(project / "code") == "130\n", read(project / "err"));
  auto topics = said_by_topic(project);
  std::set<std::int64_t> times;
  for (const char* topic : {"joint_states", "tf", "imu", "odom"}) times.merge(times_of(topics[topic]));
  const Rows rows = rows_of(project / "seen.mcap", times);
  const RobotModel model = read_urdf((project / "models/tulip/tulip.urdf").string());
  CHECK(topics["joint_states"].size() > 50);
  CHECK(times_of(topics["clock"]).contains(time_of(topics["joint_states"][topics["joint_states"].size() / 2])));

  double lowest_knee_rad = 10, highest_knee_rad = -10;
  for (const Json& message : topics["joint_states"]) {
    REQUIRE(message["name"] == Json(model.joint_names()));
    const auto& row = rows.at(time_of(message));
    for (std::size_t i = 0; i < model.joints.size(); ++i) {
      const std::string joint = "joint." + model.joints[i].name;
      REQUIRE(message["position"][i] == row.at(joint + ".position_rad"));
      REQUIRE(message["velocity"][i] == row.at(joint + ".velocity_rad_s"));
      REQUIRE(message["effort"][i] == row.at(joint + ".effort_Nm"));
    }
    lowest_knee_rad = std::min(lowest_knee_rad, row.at("joint.l_knee.position_rad"));
    highest_knee_rad = std::max(highest_knee_rad, row.at("joint.l_knee.position_rad"));
  }
  CHECK(highest_knee_rad - lowest_knee_rad > 0.5);

  Kinematics kinematics(model);
  for (const Json& message : topics["tf"]) {
    const auto& row = rows.at(time_of(message));
    const auto poses = chained(message["frames"]);
    REQUIRE(poses.size() == 1 + model.links.size());
    const Pose& base = poses.at("torso");
    REQUIRE(base.position_m == Vec3{row.at("plant.base.x_m"), row.at("plant.base.y_m"), row.at("plant.base.height_m")});
    std::vector<double> position_rad;
    for (const Joint& joint : model.joints) position_rad.push_back(row.at("joint." + joint.name + ".position_rad"));
    kinematics.update(position_rad, base);
    for (std::size_t i = 0; i < model.links.size(); ++i)
      REQUIRE(apart(poses.at(model.links[i].name).position_m, kinematics.link(i).position_m) < 1e-9);
    // Bullet keeps the soles on the ground: 0.06 m below the ankles.
    for (const char* foot : {"l_ankle_roll_link", "r_ankle_roll_link"})
      REQUIRE(std::abs(poses.at(foot).position_m[2] - 0.06) < 0.005);
  }

  CHECK(topics["odom"].size() > 50);
  for (const Json& message : topics["odom"]) {
    const auto& row = rows.at(time_of(message));
    REQUIRE(message["frame"] == "odom");
    REQUIRE(message["child"] == "torso");
    const auto at_m = message["position"].get<Vec3>();
    REQUIRE(at_m == Vec3{row.at("odometry.x_m"), row.at("odometry.y_m"), row.at("base.height_m")});
    REQUIRE(apart(at_m, {row.at("plant.base.x_m"), row.at("plant.base.y_m"), at_m[2]}) < 0.01);
    REQUIRE(std::abs(message["velocity"][0].get<double>()) < 1);
  }

  double lifted = 0;
  for (const Json& message : topics["imu"]) {
    const auto& row = rows.at(time_of(message));
    const auto angles = roll_pitch_yaw(message["orientation"].get<Quat>());
    REQUIRE(std::abs(angles[1] - row.at("base.pitch_rad")) < 1e-12);
    REQUIRE(message["rate"][1] == row.at("base.rate_y_rad_s"));
    // What the accelerometer said, gravity and noise included.
    const auto acceleration_m_s2 = message["acceleration"].get<Vec3>();
    for (std::size_t i = 0; i < 3; ++i)
      REQUIRE(acceleration_m_s2[i] == row.at(std::string("imu.acceleration_") + "xyz"[i] + "_m_s2"));
    lifted += acceleration_m_s2[2];
    REQUIRE(message["covariance"] == Json({0.0, 0.0, 0.0}));
  }
  CHECK(lifted / static_cast<double>(topics["imu"].size()) == doctest::Approx(9.81).epsilon(0.03));
  REQUIRE(topics["robot_description"].size() == 1);  // kept for who comes late
  CHECK(topics["robot_description"][0]["text"] == read(project / "models/tulip/tulip.urdf"));
  REQUIRE(topics["active"].size() == 2);  // likewise
  CHECK(topics["active"][0]["told"]["states"] == Json::array({"settle"}));
  CHECK(topics["active"][1]["told"]["behavior"] == "squat");
  CHECK(topics["active"][1]["told"]["states"] == Json::array({"squat"}));
  CHECK(topics["command_result"][0]["answer"] == Json{{"id", 1}, {"verb", "speed"}, {"done", true}, {"text", ""}});
}

TEST_CASE("orders over DDS change what runs, and a flood of rubbish changes nothing") {
  const auto project = project_copy("ros2_orders");
  REQUIRE(
      beside(project, live + " --ros2-commands",
             "peer send '{\"id\": \"p\", \"verb\": \"pause\"}' && ctl status\n"
             "peer flood 300 datagrams 300 >/dev/null\n"
             "peer send '{\"id\": 2, \"verb\": \"play\", \"text\": \"sqat\"}' send '{\"id\": 3, \"verb\": \"dance\"}'"
             " send '{\"id\": 4, \"verb\": \"resume\"}' && ctl status\n") == 0);
  const std::string said = read(project / "said"), wrong = read(project / "wrong");
  CHECK_MESSAGE(read(project / "code") == "0\n", wrong);
  CHECK_MESSAGE(wrong.empty(), wrong);
  CHECK(said.find("paused; squat") < said.find("\"id\":2"));
  CHECK(said.find("paused; squat", said.find("\"id\":4")) == std::string::npos);
  auto results = said_by_topic(project)["command_result"];
  REQUIRE(results.size() == 4);
  CHECK(results[0]["answer"]["done"] == true);
  CHECK(has(results[1]["answer"]["text"], "did you mean 'squat'"));
  CHECK(has(results[2]["answer"]["text"], "'dance' is no order; there are why enable_drives disable_drives"));
  CHECK(results[3]["answer"]["done"] == true);
  const std::string out = read(project / "out");
  const Json result = Json::parse(out.substr(out.rfind("\n{") + 1));
  CHECK(result["passed"] == true);
  CHECK(result["threads"]["control"]["missed"] == 0);
  CHECK(result["commands"]["refused"] == 0);
}

TEST_CASE("each event that a behavior declares has a topic of a type that fits its fields") {
  const auto project = project_copy("ros2_events");
  write(project / "behaviors/tulip/listen.lua", R"(local k = require "kadans"
k.events { whistle = {}, ["ball.near"] = { distance_m = { "m", min = 0, max = 5 } }, waves = { left = k.flag },
           word = { said = k.text }, seen = { x_m = "m", left = k.flag },
           cmd_vel = { forward_m_s = "m/s", left_m_s = "m/s", turn_rad_s = "rad/s" } }
local function tell(_, s)
  local d = s.event.data or {}
  print(string.format("%s: %s %s %s %s", s.event.name, tostring(d.distance_m), tostring(d.left), tostring(d.said),
    tostring(d.x_m)))
end
local function lead(_, s)
  local d = s.event.data
  print(string.format("goes %g %g %g", d.forward_m_s, d.left_m_s, d.turn_rad_s))
end
return k.behavior "listen" { k.state "wait" { endless = true,
  { on = { "whistle", "ball.near", "waves", "word", "seen" }, action = tell },
  { on = "cmd_vel", action = lead } } })");
  REQUIRE(beside(project,
                 "run config/tulip/robot.json --plant ideal --play listen --threads-on-virtual-time --ros2-commands -v",
                 "peer event whistle event ball/near=1.25 event waves=true event 'word=hi \"you\"' "
                 "event 'seen={\"x_m\": 2, \"left\": false}' event ball/near=7 "
                 "twist 0.25,-0.5,2 twist nan,0,0\n") == 0);
  const std::string err = read(project / "err");
  CHECK_MESSAGE(read(project / "code") == "0\n", err);
  CHECK(has(err, "whistle: nil nil nil nil"));
  CHECK(has(err, "ball.near: 1.25 nil nil nil"));
  CHECK(has(err, "waves: nil true nil nil"));
  CHECK(has(err, "word: nil nil hi \"you\" nil"));
  CHECK(has(err, "seen: nil false nil 2"));
  CHECK(has(err, "event whistle from ROS 2 to listen"));
  const auto results = said_by_topic(project)["command_result"];
  REQUIRE(results.size() == 8);
  CHECK(has(err, "goes 0.25 -0.5 2"));
  CHECK(results[6]["answer"]["done"] == true);
  CHECK(results[7]["answer"]["done"] == false);
  CHECK(has(results[7]["answer"]["text"], "forward_m_s"));
  CHECK(results[0]["answer"]["done"] == true);
  CHECK(results[5]["answer"]["done"] == false);
  CHECK(has(results[5]["answer"]["text"], "field 'distance_m' = 7 is outside its range 0..5 m"));
}

TEST_CASE("orders over DDS are refused unless the run was told to take them") {
  const auto project = project_copy("ros2_refused");
  REQUIRE(beside(project, live, "peer send '{\"id\": 1, \"verb\": \"estop\"}' && ctl status") == 0);
  CHECK_MESSAGE(read(project / "code") == "0\n", read(project / "err"));
  CHECK(has(read(project / "said"), "start it with --ros2-commands"));
  CHECK(has(read(project / "said"), "safety   normal"));
}

TEST_CASE("run and sim say what is wrong with a domain before anything moves") {
  const auto project = project_copy("ros2_wrong");
  const Outcome unasked = run(live + " --duration 0.1", project);
  CHECK(unasked.exit_code == 0);
  CHECK_FALSE(has(unasked.err, "ros2"));
  CHECK(run(live + " --ros2=233", project).exit_code == 2);
  CHECK(run(live + " --ros2-commands", project).exit_code == 2);
  CHECK(run("sim --from x.mcap --ros2", project).exit_code == 2);
  write(project / "wrong.sh",
        "ROS_DOMAIN_ID=$1 CYCLONEDDS_URI=$2 '" + program_path + "' " + live + " --duration 1 --ros2 >out 2>err\n");
  const auto with = [&](const std::string& environment) {
    const std::string command = "cd '" + project.string() + "' && bash wrong.sh " + environment;
    return WEXITSTATUS(std::system(command.c_str()));  // NOLINT: the point
  };
  CHECK(with("many ''") == 2);
  CHECK(has(read(project / "err"), "ROS_DOMAIN_ID: 'many' must be from 0 to 232"));
  CHECK(with("1 '<CycloneDDS><Nonsense/></CycloneDDS>'") == 2);
  CHECK(has(read(project / "err"), "CYCLONEDDS_URI"));
}
