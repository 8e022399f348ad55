// `kadans new robot`: robots that nobody has configured stand or are held by the files that it writes.
#include <cstdlib>
#include <string>
#include <tuple>

#include <doctest/doctest.h>

#include "app/program.h"
#include "app/robots_of_tests.h"

namespace kadans::program::new_robot_test {

using namespace robots_of_tests;

namespace {

// Drawing takes seconds. While this lives, no Chromium is found.
class WithoutPictures {
 public:
  WithoutPictures() : named_(std::getenv(name) == nullptr ? "" : std::getenv(name)) { setenv(name, "", 1); }
  ~WithoutPictures() {
    if (named_.empty()) unsetenv(name);
    if (!named_.empty()) setenv(name, named_.c_str(), 1);
  }
  WithoutPictures(const WithoutPictures&) = delete;
  WithoutPictures& operator=(const WithoutPictures&) = delete;

 private:
  static constexpr const char* name = "KADANS_CHROMIUM";
  std::string named_;
};

}  // namespace

TEST_CASE("new robot writes robots that stand or are held, and play their behavior") {
  const auto folder = fresh_folder("new_robot");
  const WithoutPictures none;
  for (const auto& [of, text, says] :
       {std::tuple{"spot_four", quadruped(), "It stands on fl_calf, fr_calf, rl_calf, rr_calf"},
        std::tuple{"biped", biped(), "It stands on l_foot, r_foot"}, std::tuple{"arm", arm(), "It is bolted down"}}) {
    const std::string name = of;
    CAPTURE(name);
    write(folder / "from.urdf", text);
    const Outcome made = run("new robot from.urdf", folder);
    CHECK_MESSAGE(made.exit_code == 0, (made.out + made.err));
    CHECK(has(made.err, says));
    CHECK(has(made.err, "No picture: "));
    CHECK(std::filesystem::exists(folder / "models" / name / (name + ".mcap")));  // the run names it
    CHECK(has(made.out, "PASSED"));
    CHECK(has(made.out, "behaviors/" + std::string(name) + "/sway.lua"));
    const std::string scenario = "config/scenarios/" + std::string(name) + "_hold.json";
    const Outcome sways = run("sim " + scenario + " --play sway --no-record --duration 14", folder);
    CHECK_MESSAGE(sways.exit_code == 0, (sways.out + sways.err));
    CHECK(run("behavior test behaviors/" + std::string(name), folder).exit_code == 0);
    CHECK(run("check config behaviors", folder).exit_code == 0);
  }
}

TEST_CASE("new robot lets a base on wheels roll, both ways, and what stands on it play") {
  const auto folder = fresh_folder("new_robot_cart");
  const auto make = [&](const std::string& urdf) {
    write(folder / "from.urdf", urdf);
    const Outcome made = run("new robot from.urdf --no-run", folder);
    CHECK_MESSAGE(made.exit_code == 0, (made.out + made.err));
    CHECK(has(made.err, "It rolls on left-wheel, right-wheel, its base 0.08 m high."));
  };
  const auto passes = [&](const std::string& robot, const std::string& play, const std::string& more) {
    write(folder / "config/scenarios/way.json", R"({"name": "way", "robot": "config/)" + robot +
                                                    R"(/robot.json", "duration_s": 2.3, "checks": [
               {"name": "straight", "kind": "always", "signal": "plant.base.y_m", "min": -0.02, "max": 0.02},
               {"name": "upright", "kind": "always", "signal": "plant.base.tilt_rad", "max": 0.1},)" +
                                                    more + "}");
    const Outcome rolls = run("sim config/scenarios/way.json --no-record" + play, folder);
    CAPTURE(play);
    CHECK_MESSAGE(rolls.exit_code == 0, (rolls.out + rolls.err));
  };
  const auto comes_to = [](const std::string& least_m, const std::string& most_m) {
    return R"({"name": "along", "kind": "at_end", "signal": "plant.base.x_m", "min": )" + least_m +
           ", \"max\": " + most_m +
           R"(}, {"name": "no faults", "kind": "always", "signal": "safety.faults", "max": 0}])";
  };
  make(cart());
  passes("cart", "", comes_to("-0.01", "0.01"));
  passes("cart", " --play roll", comes_to("0.4", "0.65"));  // 0.32 m/s for two seconds, a ramp of half a second in it
  passes("cart", " --play 'roll{rate_rad_s=-4}'", comes_to("-0.65", "-0.4"));
  passes("cart", " --play sway", comes_to("-0.02", "0.02"));
  CHECK(run("behavior test behaviors/cart", folder).exit_code == 0);
  // A fault lets the behavior leave: the wheels come to rest.
  passes("cart", " --play roll",
         R"({"name": "rests", "kind": "at_end", "that": "abs(joint.left-axle.velocity_rad_s) < 0.05"}],
          "faults": [{"kind": "sensor_silent", "of": "imu", "from_s": 1, "until_s": 1.4}])");
  make(cart("free", "1e9"));  // no speed is given
  passes("free", " --play roll", comes_to("0.4", "0.65"));
  CHECK(run("check config behaviors", folder).exit_code == 0);
}

TEST_CASE("new robot lets an arm sink that its motors cannot hold stretched out, and holds it from the first tick") {
  const auto folder = fresh_folder("new_robot_weak");
  const WithoutPictures none;
  std::string text = arm();  // its second joint bears 12.6 Nm when it is level
  const std::string stands = "<origin xyz=\"0 0 0.1\"";
  REQUIRE(has(text, stands));
  text.replace(text.find(stands), stands.size(), stands + " rpy=\"0 1.5708 0\"");
  for (std::size_t at = 0; (at = text.find("effort=\"", at)) != std::string::npos;) {
    at += 8;
    text.replace(at, text.find('"', at) - at, "10");
  }
  write(folder / "from.urdf", text);
  const Outcome made = run("new robot from.urdf", folder);
  CHECK_MESSAGE(made.exit_code == 0, (made.out + made.err));
  CHECK(has(made.out, "no faults"));
  const std::string robot = read(folder / "config/arm/robot.json");
  CHECK(has(robot, "\"from_off\": \"at_once\""));
}

TEST_CASE("new robot balances a trunk on a waist whose motor cannot hold it as it leans at 0") {
  const auto folder = fresh_folder("new_robot_waist");
  std::string text = biped();
  text.erase(text.find("</robot>"));
  text += link("trunk", 8, "", 0.3);  // leans by 0.25 rad: 5.8 Nm
  text += joint("waist", "pelvis", "trunk", "0 0 0.4\" rpy=\"0 0.25 0", "0 1 0", "lower=\"-1\" upper=\"1\"");
  text.replace(text.rfind("effort=\"60\""), 11, "effort=\"5\"");
  write(folder / "from.urdf", text + "</robot>");
  REQUIRE(run("new robot from.urdf --no-run", folder).exit_code == 0);
  CHECK(has(read(folder / "config/biped/robot.json"), "\"waist\": -0.08"));  // in steps of 0.02
}

TEST_CASE("new robot takes meshes of a package along that it is told of") {
  const auto folder = fresh_folder("new_robot_package");
  std::string text = arm();
  text.insert(
      text.find("<link"),
      "<link name=\"cap\"><visual><geometry><mesh filename=\"package://caps/cap.stl\"/></geometry></visual></link>"
      "<joint name=\"cap\" type=\"fixed\"><parent link=\"base\"/><child link=\"cap\"/></joint>");
  write(folder / "from.urdf", text);
  std::filesystem::create_directories(folder / "there");
  write(folder / "there/cap.stl", "solid");
  const Outcome made = run("new robot from.urdf --package caps=there --no-run", folder);
  CHECK_MESSAGE(made.exit_code == 0, made.err);
  CHECK(std::filesystem::exists(folder / "models/arm/meshes/cap.stl"));
  CHECK(has(run("new robot from.urdf --name b --package caps --no-run", folder).err, "must be NAME=FOLDER"));
}

TEST_CASE("Behaviors know the feet of a robot with four legs by name, and what each bears") {
  const auto folder = fresh_folder("new_robot_feet");
  write(folder / "from.urdf", quadruped());
  REQUIRE(run("new robot from.urdf --name four --no-run", folder).exit_code == 0);
  write(folder / "behaviors/four/weighs.lua", R"(local k = require "kadans"
local names = { "front_left", "front_right", "rear_left", "rear_right" }
return k.behavior "weighs" {
  initial = "stands",
  k.state "stands" {
    run = function(m, s)
      m:wait(2)
      local all_N = 0
      for _, name in ipairs(names) do
        assert(s.feet[name].contact, name)
        all_N = all_N + s.feet[name].force_N
      end
      assert(math.abs(all_N - 141.3) < 8, all_N)  -- 14.4 kg, and noise of sensors that push no less than 0
    end,
    { on = "run.done", to = "done" },
  },
  k.final "done" { outcome = "done" },
}
)");
  CHECK(run("check config behaviors", folder).exit_code == 0);
  const Outcome weighed = run("sim config/scenarios/four_hold.json --play weighs --no-record --duration 3", folder);
  CHECK_MESSAGE(weighed.exit_code == 0, (weighed.out + weighed.err));
}

TEST_CASE("new robot takes the meshes with it, each under a name of its own, and points the URDF to them") {
  const auto folder = fresh_folder("new_robot_meshes");
  for (const char* part : {"a", "b"}) std::filesystem::create_directories(folder / part);
  write(folder / "a/part.obj", "v 0 0 0\nv 0.1 0 0\nv 0 0.1 0\nv 0 0 0.1\nf 1 2 3\nf 1 2 4\n");
  write(folder / "b/part.obj", "v 0 0 0\nv 0.2 0 0\nv 0 0.1 0\nv 0 0 0.1\nf 1 2 3\nf 1 2 4\n");
  std::string text = arm();
  for (const char* mesh : {"a/part.obj", "b/part.obj"}) {
    const std::string shape = "<cylinder radius=\"0.03\" length=\"0.15\"/>";
    text.replace(text.find(shape), shape.size(), "<mesh filename='" + std::string(mesh) + "'/>");
  }
  write(folder / "arm.urdf", text);
  const Outcome made = run("new robot arm.urdf --in project --name mine", folder);
  CHECK_MESSAGE(made.exit_code == 0, (made.out + made.err));
  const std::string urdf = read(folder / "project/models/mine/mine.urdf");
  CHECK(has(urdf, "<mesh filename='meshes/part.obj'/>"));
  CHECK(has(urdf, "<mesh filename='meshes/part_2.obj'/>"));
  CHECK(read(folder / "project/models/mine/meshes/part_2.obj") == read(folder / "b/part.obj"));
  if (!has(made.err, "No picture: ")) CHECK(read(folder / "project/models/mine/mine.png").substr(1, 3) == "PNG");
}

TEST_CASE("new robot finds the meshes of all ways in which XML can write them") {
  const auto folder = fresh_folder("new_robot_xml");
  write(folder / "a&b c.obj", "v 0 0 0\nv 0.1 0 0\nv 0 0.1 0\nv 0 0 0.1\nf 1 2 3\nf 1 2 4\n");
  write(folder / "part.obj", read(folder / "a&b c.obj"));
  std::string text = arm();
  for (const char* mesh : {"filename = \"a&amp;b c.obj\"", "filename\n=\n'package:///part.obj'"}) {
    const std::string shape = "<cylinder radius=\"0.03\" length=\"0.15\"/>";
    text.replace(text.find(shape), shape.size(), "<mesh " + std::string(mesh) + "/>");
  }
  write(folder / "arm.urdf", "<!-- filename=\"part.obj\" -->" + text);
  const Outcome made = run("new robot arm.urdf --in project --no-run", folder);
  CHECK_MESSAGE(made.exit_code == 0, (made.out + made.err));
  const std::string urdf = read(folder / "project/models/arm/arm.urdf");
  CHECK(has(urdf, "<!-- filename=\"part.obj\" -->"));
  CHECK(has(urdf, "<mesh filename = \"meshes/a_b_c.obj\"/>"));
  CHECK(has(urdf, "<mesh filename\n=\n'meshes/part.obj'/>"));
  const Outcome checked = run("check --strict project/models/arm/arm.urdf", folder);
  CHECK_MESSAGE(checked.exit_code == 0, (checked.out + checked.err));
}

TEST_CASE("new robot holds joints as stiffly as their damping and friction ask for") {
  const auto folder = fresh_folder("new_robot_damped");
  std::string text = arm();
  const std::string end = "</joint>";
  for (std::size_t at = 0; (at = text.find(end, at)) != std::string::npos;) {
    const std::string damped = "<dynamics damping=\"6\" friction=\"0.4\"/>" + end;
    text.replace(at, end.size(), damped);
    at += damped.size();
  }
  write(folder / "from.urdf", text);
  REQUIRE(run("new robot from.urdf --no-run", folder).exit_code == 0);
  const Outcome nod = run("new behavior nod", folder);
  CHECK_MESSAGE(nod.exit_code == 0, (nod.out + nod.err));
}

TEST_CASE("new robot takes no legs for wheels, whatever turns without end, and says why it bolts a robot down") {
  const auto folder = fresh_folder("new_robot_why");
  const auto said = [&](const std::string& urdf, const std::string& options = "") {
    static int made = 0;
    write(folder / "from.urdf", urdf);
    const Outcome outcome = run("new robot from.urdf --no-run --name it" + std::to_string(++made) + options, folder);
    CHECK_MESSAGE(outcome.exit_code == 0, (outcome.out + outcome.err));
    return outcome.err;
  };
  std::string square = cart();
  const auto replace_all = [](std::string& text, const std::string& from, const std::string& to) {
    REQUIRE(has(text, from));
    for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
      text.replace(at, from.size(), to);
  };
  replace_all(square, "<cylinder radius=\"0.08\" length=\"0.03\"/>", "<box size=\"0.16 0.16 0.03\"/>");
  CHECK(!has(said(square), "It rolls on"));
  std::string free_wheels = cart();
  replace_all(free_wheels, "effort=\"2\"", "effort=\"0\"");
  CHECK(has(said(free_wheels), "It is bolted down (plant.fixed_base): its wheels have no motors."));
  CHECK(has(said(arm()), "It is bolted down (plant.fixed_base): "));
}

TEST_CASE("new robot overwrites nothing, and refuses what it can make no robot of") {
  const auto folder = fresh_folder("new_robot_refused");
  write(folder / "arm.urdf", arm());
  std::filesystem::create_directories(folder / "behaviors/arm");
  const Outcome taken = run("new robot arm.urdf", folder);
  CHECK(taken.exit_code == 2);
  CHECK(has(taken.err, "behaviors/arm: is there already; nothing is overwritten"));
  CHECK(!std::filesystem::exists(folder / "models"));
  CHECK(has(run("new robot arm.urdf --name Arm --no-run", folder).err, "arm.urdf: 'Arm': a robot's name is words"));
  const Outcome no_srdf = run("new robot arm.urdf --name other --srdf arm.urdf --no-run", folder);
  CHECK(no_srdf.exit_code == 2);
  CHECK(has(no_srdf.err, "> in its <robot>: this is a URDF"));
  CHECK(has(run("new robot none.urdf", folder).err, "there is no such file"));
  std::string limp = arm();
  for (std::size_t at; (at = limp.find("effort=\"60\"")) != std::string::npos;) limp.replace(at, 11, "effort=\"0\"");
  write(folder / "limp.urdf", limp);
  const Outcome refused = run("new robot limp.urdf --name limp", folder);
  CHECK(refused.exit_code == 2);
  CHECK(has(refused.err, "no joint of it has a motor"));
}

}  // namespace kadans::program::new_robot_test
