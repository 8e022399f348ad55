// Each shipped scenario fails when what it is there to show is broken: one edit of the robot, of a behavior or of the
// scenario itself, and the check that must see it. A scenario without a row here is an error.
#include <algorithm>
#include <array>
#include <filesystem>
#include <string>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "app/program.h"

namespace broken_point_test {

using namespace kadans::program;

namespace {

struct Breakage {
  const char* scenario;
  const char* file;  // "": the scenario's own
  const char* from;
  const char* to;
  const char* seen_by;
};

constexpr const char* robot = "config/tulip/robot.json";
constexpr const char* reaching = "config/reaching/robot.json";
constexpr const char* stand = "behaviors/tulip/stand.lua";
constexpr const char* getting_up = "behaviors/tulip/get_up.lua";
constexpr const char* rises = "set_gains(\"rise\")";
constexpr const char* sinks = "set_gains(\"balance\")";
constexpr const char* keeping_up = "behaviors/tulip/keep_up.lua";
constexpr const char* steps = "c.walk:set(\"go\", 1)";
constexpr const char* rests = "c.walk:set(\"go\", 0)";
constexpr const char* squat = "behaviors/tulip/squat.lua";
constexpr const char* stiff = "set_gains(\"stiff\")";
constexpr const char* soft = "set_gains(\"soft\")";  // the joints still hold their pose, the robot does not stand

constexpr std::array<Breakage, 76> breakages = {{
    {"behaviors_stall", robot, "\"heartbeat_timeout_s\": 0.1", "\"heartbeat_timeout_s\": 1",
     "found within the timeout"},
    {"commands_lost", "", "\"from_s\": 1,", "\"from_s\": 2,", "nothing lost happens late"},
    {"foot_sensor_lost", "", "\"sensor_not_finite\"", "\"sensor_stuck\"", "found within 20 ms"},
    {"gaze_pursuit", "behaviors/head/pursue.lua", "P.side_m * w * math.cos", "0 * w * math.cos",
     "the gaze is never 2 degrees off"},
    {"gaze_pushed", "config/head/robot.json", "\"gain_per_s\": 18", "\"gain_per_s\": 0.5",
     "the gaze stays within 2 degrees"},
    {"gaze_saccade", "config/head/robot.json", "\"gain_per_s\": 18", "\"gain_per_s\": 4",
     "settles on what is left within 0.35 s, below 0.5 degrees"},
    {"gaze_stick", "behaviors/head/stick.lua", "-P.velocity_m_s * s.joystick.x", "-0.1 * s.joystick.x",
     "the target goes to the left and up"},
    {"gaze_unreachable", "behaviors/head/wander.lua", "x = -0.4, y = 0.0, z = -0.3", "x = 1.0, y = 0.0, z = 0.3",
     "what is under its back is told to be out of reach"},
    {"get_up_left", getting_up, rises, sinks, "leans less than 0.2 rad"},
    {"get_up_prone", getting_up, rises, sinks, "leans less than 0.2 rad"},
    {"get_up_right", getting_up, rises, sinks, "leans less than 0.2 rad"},
    {"get_up_supine", getting_up, rises, sinks, "leans less than 0.2 rad"},
    {"imu_silent", robot, "\"silent_ticks_max\": 5", "\"silent_ticks_max\": 400", "found within 20 ms"},
    {"jiwiy_sine", "", "[0, 0.001, 0.002]", "[0.03, 0.03, 0.03]", "both joints follow within 5 % and 5 degrees"},
    {"jiwiy_switched", "config/jiwiy/robot.json", "\"velocity_gain_Nms_per_rad\": 0.28",
     "\"velocity_gain_Nms_per_rad\": 28", "no torque steps by 5 % of its limit"},
    {"jiwiy_unplugged", "", "\"lost_at_s\": 2.4", "\"lost_at_s\": 24", "comes to rest"},
    {"keep_up_backward", keeping_up, steps, rests, "stays up"},
    {"keep_up_forward", keeping_up, steps, rests, "stays up"},
    {"keep_up_forward", "", "[8, 0, 0]", "[3, 0, 0]", "steps, as it has to"},
    {"keep_up_left", keeping_up, steps, rests, "steps, as it has to"},
    {"knee_sensor_jumps", "", "\"size\": 0.5", "\"size\": 0.005", "found at once"},
    {"late_drives", "", "0.002", "0.02", "stays up"},
    {"list_of_behaviors", squat, "outcome = \"done\"", "outcome = \"failed\"", "the arm is raised"},
    {"payload_dropped", stand, stiff, soft, "sways ever less, upright"},
    {"payload_dropped", "", "\"mass_kg\": 1.5", "\"mass_kg\": 0.5", "the load is felt"},
    {"payload_front", squat, stiff, soft, "stays up"},
    {"payload_front", "", "\"mass_kg\": 1,", "\"mass_kg\": 8,", "torso upright, rad"},
    {"push_backward", stand, stiff, soft, "stays up"},
    {"push_backward_left", stand, stiff, soft, "stays up"},
    {"push_backward_right", stand, stiff, soft, "stays up"},
    {"push_forward", stand, stiff, soft, "stays up"},
    {"push_forward", "", "[2, 0, 0]", "[0, 0, 0]", "the push is felt"},
    {"push_forward_left", stand, stiff, soft, "stays up"},
    {"push_forward_right", stand, stiff, soft, "stays up"},
    {"push_left", stand, stiff, soft, "stays up"},
    {"push_left", "", "[0, 2, 0]", "[0, 20, 0]", "stays up"},
    {"push_right", stand, stiff, soft, "stays up"},
    {"reload_while_down", "config/scenarios/versions/squat.lua", "k.state \"squat\"", "k.state \"sqat\"",
     "reloaded once"},
    {"reload_while_down", "", "\"at_s\": 2.2", "\"at_s\": 8", "reloaded once"},
    {"shaken_floor", stand, stiff, soft, "sways ever less, upright"},
    {"shaken_floor", "", "[-0.06, 0, 0]", "[-0.6, 0, 0]", "stays up"},
    {"side_by_side", "", "\"start.y_m\": 0.6", "\"start.y_m\": 6", "the other feels it, N"},
    {"slippery_floor", "", "0.1 }", "0.8 }", "slides"},
    {"slope_across", "", "0.035", "0.25", "stays up"},
    {"slope_up", "", "0.035", "0.25", "stays up"},
    {"soft_get_up_prone", getting_up, rises, sinks, "leans less than 0.2 rad"},
    {"soft_get_up_supine", getting_up, rises, sinks, "leans less than 0.2 rad"},
    {"soft_keep_up_forward", keeping_up, steps, rests, "stays up"},
    {"soft_squat", "config/tulip/soft.json", "\"*_hip_pitch.damping_ratio\": 0.44",
     "\"*_hip_pitch.damping_ratio\": 0.01", "torso upright, rad"},
    {"squat", squat, "P.depth_m)", "0.01)", "crouches, lowest height in m"},
    {"squat", squat, stiff, soft, "height follows, m"},
    {"squat_varied", "", "[0.9, 1.0]", "[0.05, 0.1]", "torso upright, rad"},
    {"stay_up_backward_left", robot, "\"pull_x\": 8", "\"pull_x\": 0", "stays up"},
    {"stay_up_forward", robot, "\"pull_x\": 8", "\"pull_x\": 0", "stays up"},
    {"stay_up_left", robot, "\"pull_x\": 8", "\"pull_x\": 0", "stays up"},
    {"stay_up_right", "behaviors/tulip/stay_up.lua", "(\"share\", 1)", "(\"share\", 0)", "stays up"},
    {"ticks_missed", "", "\"size\": 3", "\"size\": 8", "all three are counted"},
    {"touched_feet", "behaviors/hanging/touched.lua", "c:use(\"held\")", "c:use(\"loose\")",
     "held in the tick of a contact, loose in the tick after the last one"},
    {"kick", "behaviors/lib/walking.lua", "rolls = 0.71", "rolls = 1.1", "the ball goes, m"},
    {"kick", "behaviors/tulip/kick.lua", "P.rad, P.far_m", "P.rad + 0.25, P.far_m", "the ball goes straight, m"},
    {"fetch", "behaviors/tulip/fetch.lua", "near_m  = { 0.6", "near_m  = { 1.2", "is before the ball, m"},
    {"go_to_ball", "behaviors/lib/ball.lua", "seen.x_m, seen.y_m)", "seen.x_m, -seen.y_m)", "a goal"},
    {"walk_cycle", "behaviors/tulip/walk_cycle.lua", "c:use(a.stands)", "c:use(a.swings)", "stays up"},
    {"dribble", "behaviors/lib/dribbling.lua", "walk.kick(m, soon, rad,", "walk.kick(m, soon, rad + 0.4,",
     "along its line, m"},
    {"dribble", "behaviors/lib/ball.lua", "seen.x_m, seen.y_m)", "seen.x_m, -seen.y_m)",
     "3.9 m in 15.6 s, set out included: 0.25 m/s"},
    {"walk_two_steps", "config/tulip/robot.json", "\"type\": \"dcm_walk\",",
     "\"type\": \"dcm_walk\", \"parameters\": { \"brake_m_s2\": 0.5 },",
     "steps no more than two times after it is told to stop"},
    {"walk_two_steps", "", "m_s=0.4", "m_s=0.2", "walks so after two steps"},
    {"walk", robot, "\"type\": \"dcm_walk\",", "\"type\": \"dcm_walk\", \"parameters\": { \"trust_per_s\": 0 },",
     "stays up"},
    {"walk", "", "for_s=6", "for_s=60", "stands still at the end"},
    {"weak_knees", "", "0.6 }", "0.15 }", "stays up"},
    {"whole_body", "behaviors/reaching/reach.lua", "weight = 30", "weight = 0", "stretches the arm, rad"},
    {"whole_body", reaching, "\"*_ankle_pitch.stiffness_Nm_per_rad\": 300", "\"*_ankle_pitch.stiffness_Nm_per_rad\": 1",
     "stays up, lowest height in m"},
    {"whole_body_anywhere", reaching, "\"*_ankle_pitch.stiffness_Nm_per_rad\": 300",
     "\"*_ankle_pitch.stiffness_Nm_per_rad\": 1", "stands at the end"},
    {"whole_body_gaze", "behaviors/looking/watch.lua", "{ 1, 0.6, -0.1 }", "{ 1, 0.3, -0.1 }", "looks left"},
    {"whole_body_switched", reaching, "\"*_ankle_pitch.stiffness_Nm_per_rad\": 300",
     "\"*_ankle_pitch.stiffness_Nm_per_rad\": 10", "no step in torque over 2 % of a limit"},
    {"whole_body_varied", "", "[0.9, 1.0]", "[0.05, 0.1]", "stays up, lowest height in m"},
}};

bool has_row(const std::string& scenario) {
  return std::any_of(breakages.begin(), breakages.end(), [&](const Breakage& b) { return scenario == b.scenario; });
}

bool failed(const nlohmann::json& report, const std::string& check) {
  for (const auto& c : report["checks"]) {
    if (c["name"] == check) return !c["passed"].get<bool>();
  }
  FAIL("there is no check " << check);
  return false;
}

}  // namespace

TEST_CASE("Every shipped scenario fails when its point is broken, and by the check that is there for it") {
  const auto folder = project_copy("broken_point");
  for (const Breakage& broken : breakages) {
    const std::string scenario = "config/scenarios/" + std::string(broken.scenario) + ".json";
    const auto file = folder / (*broken.file ? broken.file : scenario);
    CAPTURE(scenario);
    CAPTURE(std::string(broken.to));
    const std::string right = read(file);
    REQUIRE(edit(file, broken.from, broken.to));
    const Outcome outcome = run("sim " + scenario + " --no-record --json", folder);
    write(file, right);
    CAPTURE(outcome.err);
    REQUIRE(outcome.exit_code == 1);
    CHECK(failed(nlohmann::json::parse(outcome.out), broken.seen_by));
  }
}

TEST_CASE("No shipped scenario is without a proof that it can fail") {
  for (const auto& entry : std::filesystem::directory_iterator(std::string(KADANS_SOURCE_DIR) + "/config/scenarios")) {
    if (entry.path().extension() != ".json" || entry.path().stem() == "golden") continue;
    CAPTURE(entry.path().stem().string());
    CHECK(has_row(entry.path().stem().string()));
  }
}

}  // namespace broken_point_test
