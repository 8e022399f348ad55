// Bodies of an MJCF that meshes weigh, judged by libmujoco where that is installed.
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "kadans/model/mjcf.h"
#include "kadans/signal/input_error.h"
#include "kadans/signal/random.h"
#include "temporary_folder.h"
#ifdef KADANS_MUJOCO
#include "mjcf_judge.h"
#endif

namespace kadans {
namespace {

std::string stl(const std::vector<MeshTriangle>& triangles) {
  const auto count = static_cast<std::uint32_t>(triangles.size());
  std::string text(80, ' ');
  text.append(reinterpret_cast<const char*>(&count), sizeof(count));
  for (const MeshTriangle& triangle : triangles) {
    text.append(12, '\0');  // the normal
    text.append(reinterpret_cast<const char*>(triangle.data()), sizeof(triangle));
    text.append(2, '\0');
  }
  return text;
}

// Reads what stl() writes.
std::vector<MeshTriangle> triangles_in(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  std::vector<MeshTriangle> triangles((text.size() - 84) / 50);
  for (std::size_t i = 0; i < triangles.size(); ++i)
    std::memcpy(triangles[i].data(), text.data() + 84 + 50 * i + 12, sizeof(MeshTriangle));
  return triangles;
}

// A closed body with a dent: a star of rays of different lengths around a point.
std::vector<MeshTriangle> star() {
  RandomStream random(4, "star");
  std::array<std::array<float, 3>, 6> tips{};
  for (std::size_t i = 0; i < 6; ++i) {
    for (float& part : tips[i]) part = static_cast<float>(random.uniform(-0.02, 0.02));
    tips[i][i / 2] += (i % 2 == 0 ? 1.0F : -1.0F) * static_cast<float>(random.uniform(0.05, 0.2));
  }
  std::vector<MeshTriangle> faces;
  for (const std::size_t x : {0U, 1U}) {
    for (const std::size_t y : {2U, 3U}) {
      for (const std::size_t z : {4U, 5U}) {
        const bool turned = (x + y + z) % 2 == 1;
        const auto &a = tips[x], &b = tips[turned ? z : y], &c = tips[turned ? y : z];
        faces.push_back({a[0] + 0.3F, a[1], a[2], b[0] + 0.3F, b[1], b[2], c[0] + 0.3F, c[1], c[2]});
      }
    }
  }
  return faces;
}

// Triangles anyhow, which only the legacy way takes.
std::vector<MeshTriangle> soup() {
  RandomStream random(5, "soup");
  std::vector<MeshTriangle> faces(40);
  for (MeshTriangle& face : faces) {
    for (float& part : face) part = static_cast<float>(random.uniform(-0.1, 0.12));
  }
  return faces;
}

std::string robot(const std::string& compiler) {
  return "<mujoco><compiler angle=\"radian\" " + compiler + R"(/><asset>
    <mesh name="a" file="a.stl" scale="1.1 0.7 1.3"/><mesh name="b" file="b.stl"/></asset><worldbody>
    <body name="base"><freejoint/><geom type="mesh" mesh="a" pos="0.1 0.2 0.3" euler="0.3 0.2 0.1"/>
      <geom size="0.3" group="4"/>
      <body name="arm" pos="0.2 0 0.1"><joint name="j" axis="0.2 1 0"/>
        <geom type="mesh" mesh="b" mass="1.5" pos="0.1 0 0"/><geom type="mesh" mesh="b" density="300" euler="0 1 0"/>
      </body>
    </body></worldbody></mujoco>)";
}

std::string error_of(const std::string& file, const UrdfOptions& options) {
  try {
    (void)read_mjcf(file, options);
  } catch (const InputError& error) {
    return error.problems().front().message;
  }
  return "accepted";
}

const UrdfOptions reading{.mesh_triangles = triangles_in};

}  // namespace

TEST_CASE("Meshes weigh a body without inertial where they can be read, and else it is refused with what to do") {
  const test::TemporaryFolder files;
  const std::string file = files.write("robot.xml", robot(""));
  const std::string start = "link 'base' has no <inertial>, and its mesh would give it one";
  files.write("a.stl", stl(star()));
  files.write("b.stl", stl(soup()));
  CHECK(error_of(file, {}).starts_with(start + ": let MuJoCo compile and save the model"));
  CHECK(error_of(file, reading) == "accepted");
  files.write("a.stl", stl({MeshTriangle{0, 0, 0, 1, 0, 0, 0, 1, 0}}));
  CHECK(error_of(file, reading).starts_with(start + ", but 'a.stl' encloses no volume: let MuJoCo"));
  const std::string elsewhere = files.write("else/robot.xml", robot(""));
  CHECK(error_of(elsewhere, reading).starts_with(start + ", but 'a.stl' is not there: let MuJoCo"));
  files.write("a.stl", stl(star()));
  const UrdfOptions broken{.mesh_triangles = [](const std::string&) -> std::vector<MeshTriangle> {
    throw InputError({.message = "cannot be read as a mesh"});
  }};
  CHECK(error_of(file, broken).starts_with(start + ", but 'a.stl' cannot be read as a mesh: let MuJoCo"));
  const RobotModel model = read_urdf_text(read_mjcf(file, reading).urdf, "made.urdf");
  CHECK(model.links[1].inertia.mass_kg > 1.5);
}

TEST_CASE("Masses that the file scales, and groups that it weighs, are those of the robot") {
  const test::TemporaryFolder files;
  files.write("a.stl", stl(star()));
  files.write("b.stl", stl(soup()));
  const auto mass_kg = [&](const std::string& compiler) {
    return read_mjcf(files.write("robot.xml", robot(compiler)), reading).model.mass_kg();
  };
  CHECK(mass_kg("settotalmass=\"7\"") == doctest::Approx(7));
  CHECK(mass_kg("") - mass_kg("inertiagrouprange=\"0 3\"") == doctest::Approx(1000 * 4.0 / 3 * M_PI * 0.027));
}

#ifdef KADANS_MUJOCO
TEST_CASE("What meshes weigh is what libmujoco computes, in both of its ways") {
  const test::TemporaryFolder files;
  files.write("a.stl", stl(star()));
  for (const bool exact : {false, true}) {
    CAPTURE(exact);
    files.write("b.stl", stl(exact ? star() : soup()));
    const std::string compiler = exact ? "exactmeshinertia=\"true\" settotalmass=\"7\"" : "inertiagrouprange=\"0 3\"";
    const test::JudgedRobot judged = test::judge(files.write("robot.xml", robot(compiler)), 20, reading);
    REQUIRE_MESSAGE(judged.judged, judged.why);
    CHECK(judged.mass < 1e-12);
    CHECK(judged.mass_matrix < 1e-9);  // its principal axes are that exact
    CHECK(judged.bias < 1e-9);
    CHECK(judged.acceleration < 1e-7);
  }
}
#endif

}  // namespace kadans
