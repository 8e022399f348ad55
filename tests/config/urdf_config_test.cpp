// What a URDF says of drives and limits is what a robot's configuration begins with, and may change.
#include <filesystem>
#include <fstream>
#include <string>

#include <doctest/doctest.h>

#include "broken.h"
#include "config/robot/robot_config.h"
#include "kadans/signal/input_error.h"
#include "right_texts.h"
#include "temporary_folder.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;

// The TULip's URDF with a geared knee, a rotor and soft limits, in a folder of its own.
class GearedTulip {
 public:
  GearedTulip() {
    std::ifstream in(KADANS_SOURCE_DIR "/models/tulip/tulip.urdf", std::ios::binary);
    std::string text{std::istreambuf_iterator<char>(in), {}};
    text.replace(text.rfind("</robot>"), 8,
                 "<transmission name=\"t\"><type>transmission_interface/SimpleTransmission</type><joint "
                 "name=\"l_knee\"/><actuator name=\"m\"><mechanicalReduction>50</mechanicalReduction><motorInertia>4e-6"
                 "</motorInertia></actuator></transmission><gazebo/></robot>");
    text.insert(text.find('>', text.find("<joint name=\"l_knee\"")) + 1,
                "<safety_controller k_velocity=\"1\" soft_lower_limit=\"0.1\" soft_upper_limit=\"2\"/>");
    for (const char* name : {"geared.urdf", "geared.xacro"}) folder_.write(name, text);
  }
  std::string file(const std::string& name) const { return folder_.file(name); }

 private:
  test::TemporaryFolder folder_;
};

RobotConfig read_with_urdf(const std::string& urdf, const std::string& more = "") {
  std::string text = replaced(right_robot, "models/tulip/tulip.urdf", urdf.c_str());
  text =
      replaced(text.c_str(), "\"*\": { \"rotor_inertia_kg_m2\": 0.02 }", "\"r_*\": { \"rotor_inertia_kg_m2\": 0.02 }");
  text = replaced(text.c_str(), "\"name\": \"tulip\"", ("\"name\": \"tulip\"" + more).c_str());
  return read_robot_config_text(text, KADANS_SOURCE_DIR "/config/t.json", std::vector<std::string>{"joint_pid"});
}

}  // namespace

TEST_CASE("The URDF's gear, rotor and soft limits are the robot's where its configuration says nothing") {
  const GearedTulip tulip;
  const RobotConfig config = read_with_urdf(tulip.file("geared.urdf"));
  const std::size_t knee = config.model.find_joint("l_knee").value();
  CHECK(config.plant.drives[knee].rotor_inertia_kg_m2 == doctest::Approx(4e-6 * 2500));
  CHECK(config.safety.joints[knee].lower_rad == 0.1);
  CHECK(config.safety.joints[knee].upper_rad == 2);
  CHECK(config.model.joints[knee].upper_rad > 2);  // the end stop
  REQUIRE(config.model.transmissions.size() == 1);
  CHECK(config.model.transmissions[0].drive_per_joint(0, 0) == 50);
  REQUIRE(config.urdf_warnings.size() == 2);  // <gazebo> and k_velocity
}

TEST_CASE("A transmission of the configuration goes before the URDF's of the same joint") {
  const GearedTulip tulip;
  const RobotConfig config =
      read_with_urdf(tulip.file("geared.urdf"),
                     R"(, "transmissions": [{ "type": "simple", "joints": ["l_knee"], "actuator_reduction": [-3] }])");
  REQUIRE(config.model.transmissions.size() == 1);
  CHECK(config.model.transmissions[0].drive_per_joint(0, 0) == -3);
}

TEST_CASE("A configuration may name an SRDF, whose pairs of links pass through each other") {
  const test::TemporaryFolder folder;
  const std::string srdf = folder.write("tulip.srdf",
                                        "<robot name=\"tulip\"><disable_collisions link1=\"torso\" "
                                        "link2=\"l_ankle_roll_link\" reason=\"Never\"/></robot>");
  const auto read_with = [&](const std::string& file) {
    const std::string text = replaced(right_robot, "\"solver_iterations\": 10",
                                      ("\"srdf\": \"" + file + "\", \"solver_iterations\": 10").c_str());
    return read_robot_config_text(text, KADANS_SOURCE_DIR "/config/t.json", std::vector<std::string>{"joint_pid"});
  };
  const std::pair<std::string, std::string> pair{"torso", "l_ankle_roll_link"};
  CHECK(read_with(srdf).plant.passing == std::vector{pair});
  CHECK_THROWS_WITH_AS((void)read_with("models/none.srdf"), doctest::Contains("none.srdf"), InputError);
}

TEST_CASE("A configuration that names xacro is told to name what it expands to") {
  const GearedTulip tulip;
  CHECK_THROWS_WITH_AS((void)read_with_urdf(tulip.file("geared.xacro")),
                       doctest::Contains("urdf is xacro: expand it once"), InputError);
}

}  // namespace kadans
