// Meshes as files have them, read by kadans-hull.
#include "config/robot/mesh_hull.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include <doctest/doctest.h>
#include <stdlib.h>

#include "broken.h"
#include "config/robot/robot_config.h"
#include "kadans/signal/input_error.h"
#include "right_texts.h"
#include "temporary_folder.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;

// A folder for meshes, with a cache of its own.
class Meshes : public test::TemporaryFolder {
 public:
  Meshes() { REQUIRE(setenv("XDG_CACHE_HOME", path().c_str(), 1) == 0); }  // NOLINT(concurrency-mt-unsafe)
  ~Meshes() { unsetenv("XDG_CACHE_HOME"); }                                // NOLINT(concurrency-mt-unsafe)
  Meshes(const Meshes&) = delete;
  Meshes& operator=(const Meshes&) = delete;

  fs::path cache() const { return path() / "kadans" / "hulls"; }
};

std::vector<Vec3> sorted(std::vector<Vec3> corners) {
  std::ranges::sort(corners);
  return corners;
}

std::string line(const char* format, double x, double y, double z) {
  std::array<char, 96> text{};
  std::snprintf(text.data(), text.size(), format, x, y, z);
  return text.data();
}

// A box from 0 to (1, 2, 3) with a point inside, as Wavefront OBJ.
std::string box_obj() {
  std::string text;
  for (int i = 0; i < 8; ++i) text += line("v %g %g %g\n", i & 1, (i & 2) != 0 ? 2 : 0, (i & 4) != 0 ? 3 : 0);
  return text + "v 0.5 1 1.5\nf 1 2 3\nf 2 4 3\nf 5 6 7\nf 6 8 7\nf 1 9 8\n";
}

// Points of a sphere of radius 1 as triangles that lie in it, as STL.
std::string ball_stl(int count) {
  std::string text = "solid ball\n";
  const auto point = [&](int i) {
    const double z = 1 - (2.0 * (i % count) + 1) / count, angle = 2.399963 * (i % count), r = std::sqrt(1 - z * z);
    return line("vertex %.9g %.9g %.9g\n", r * std::cos(angle), r * std::sin(angle), z);
  };
  for (int i = 0; i < count; ++i)
    text += "facet normal 0 0 1\nouter loop\n" + point(i) + point(i + 1) + point(i + 2) + "endloop\nendfacet\n";
  return text + "endsolid ball\n";
}

// A triangle in centimetres and with z up, in a node that is moved by 1 m along x, as Collada.
std::string collada(const std::string& up) {
  return R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit meter="0.01" name="centimeter"/><up_axis>)" +
         up + R"(</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="a" count="12">0 0 0 100 0 0 0 200 0 0 0 300</float_array>
<technique_common><accessor source="#a" count="4" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="2"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2 0 1 3</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node><translate>100 0 0</translate><instance_geometry url="#g"/></node>
</visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
}

std::string refusal(const std::string& file) {
  try {
    (void)mesh_hull(file);
  } catch (const InputError& error) {
    return error.problems().front().message;
  }
  return "none";
}

}  // namespace

TEST_CASE("The hull of a box is its eight corners, whatever lies inside") {
  const Meshes meshes;
  const auto corners = sorted(mesh_hull(meshes.write("box.obj", box_obj())));
  REQUIRE(corners.size() == 8);
  CHECK(corners.front() == Vec3{0, 0, 0});
  CHECK(corners.back() == Vec3{1, 2, 3});
}

TEST_CASE("All triangles of a mesh are read, faces of more corners cut into them") {
  const Meshes meshes;
  const auto triangles = mesh_triangles(meshes.write("flat.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n"));
  REQUIRE(triangles.size() == 2);
  double area = 0;
  for (const MeshTriangle& t : triangles)
    area += static_cast<double>(std::abs((t[3] - t[0]) * (t[7] - t[1]) - (t[6] - t[0]) * (t[4] - t[1]))) / 2;
  CHECK(area == 1);
  CHECK(mesh_triangles(meshes.write("ball.stl", ball_stl(400))).size() == 400);
  CHECK_THROWS_WITH_AS((void)mesh_triangles(meshes.write("none.stl", "solid")),
                       doctest::Contains("cannot be read as a mesh: "), InputError);
}

TEST_CASE("A Collada file counts in its own unit, with its nodes, and its axes as they stand") {
  const Meshes meshes;
  for (const char* const up : {"Z_UP", "Y_UP"}) {
    CAPTURE(up);
    const auto corners = sorted(mesh_hull(meshes.write(std::string(up) + ".dae", collada(up))));
    REQUIRE(corners.size() == 4);
    const std::vector<Vec3> wanted{{1, 0, 0}, {1, 0, 3}, {1, 2, 0}, {2, 0, 0}};
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t k = 0; k < 3; ++k) CHECK(corners[i][k] == doctest::Approx(wanted[i][k]).epsilon(1e-6));
    }
  }
}

TEST_CASE("A hull of many corners keeps those that matter, all of them its own") {
  const Meshes meshes;
  const auto corners = mesh_hull(meshes.write("ball.stl", ball_stl(400)));
  REQUIRE(corners.size() == mesh_corners_max);
  const auto along = [](const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; };
  for (const Vec3& corner : corners) CHECK(along(corner, corner) == doctest::Approx(1).epsilon(1e-6));
  // In every direction the hull reaches nearly as far as the ball: 32 even points leave caps of 12 %.
  for (int i = 0; i < 200; ++i) {
    const double z = 1 - (2.0 * i + 1) / 200, angle = 1.7 * i, r = std::sqrt(1 - z * z);
    double reach = -1;
    for (const Vec3& corner : corners)
      reach = std::max(reach, along(corner, {r * std::cos(angle), r * std::sin(angle), z}));
    CHECK(reach > 0.85);
  }
}

TEST_CASE("A mesh that is flat or a line has a hull, too") {
  const Meshes meshes;
  CHECK(mesh_hull(meshes.write("flat.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n")).size() == 4);
  CHECK(mesh_hull(meshes.write("line.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n")).size() >= 2);
}

TEST_CASE("A mesh of more than a million triangles has a hull, although its triangles are too many to be read") {
  const Meshes meshes;
  std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  for (int i = 0; i < 1'000'001; ++i) text += "f 1 2 3\n";
  const std::string file = meshes.write("many.obj", text);
  CHECK(mesh_hull(file).size() == 3);
  CHECK_THROWS_WITH_AS((void)mesh_triangles(file), doctest::Contains("it has more than a million triangles"),
                       InputError);
}

TEST_CASE("What is no mesh is refused with what its reader says") {
  const Meshes meshes;
  CHECK(refusal(meshes.write("text.stl", "a letter")).starts_with("cannot be read as a mesh: "));
  CHECK(refusal(meshes.write("empty.obj", "")).starts_with("cannot be read as a mesh: "));
  CHECK(refusal(meshes.write("other.xyz", "a letter")).starts_with("cannot be read as a mesh: "));
  CHECK(refusal(meshes.write("nan.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")) != "none");
}

TEST_CASE("A hull is kept by the content of its file, and one that was damaged is made again") {
  const Meshes meshes;
  const std::string file = meshes.write("box.obj", box_obj());
  const auto corners = mesh_hull(file);
  const fs::path kept = *fs::directory_iterator(meshes.cache());
  std::ofstream(kept) << R"({"corners": [[7, 8, 9]]})";
  CHECK(mesh_hull(meshes.write("copy.obj", box_obj())) == std::vector<Vec3>{{7, 8, 9}});
  CHECK(mesh_hull(meshes.write("other.obj", box_obj() + "v 9 9 9\nf 1 2 10\n")).size() > 1);
  for (const char* const damaged :
       {"", "{", R"({"corners": []})", R"({"corners": [[1, 2]]})", R"({"corners": [[1, 2, "x"]]})"}) {
    CAPTURE(damaged);
    std::ofstream(kept) << damaged;
    CHECK(mesh_hull(file) == corners);
  }
}

// TULip's torso is a box, a waist and a head; here the chest is the mesh of a box from 0 to (1, 2, 3).
TEST_CASE("A robot's configuration says how its links collide: as a box, as other meshes, or not at all") {
  const Meshes meshes;
  std::ifstream in(KADANS_SOURCE_DIR "/models/tulip/tulip.urdf", std::ios::binary);
  const std::string tulip{std::istreambuf_iterator<char>(in), {}};
  const std::string file = meshes.write("box.obj", box_obj());
  const std::string urdf = meshes.write("t.urdf", replaced(tulip, "<box size=\"0.16 0.24 0.23\"/>",
                                                           "<mesh filename=\"box.obj\" scale=\"0.1 0.1 0.1\"/>"));
  const auto read = [&](const std::string& collisions) {
    std::string text = replaced(right_robot, "models/tulip/tulip.urdf", urdf);
    text = replaced(text, "\"plant\": {", "\"plant\": { \"collisions\": {" + collisions + "},");
    return read_robot_config_text(text, KADANS_SOURCE_DIR "/config/t.json", std::vector<std::string>{"joint_pid"});
  };
  const auto torso = [&](const std::string& collisions) { return read(collisions).model.links[0].collisions; };
  const auto described = torso("");
  CHECK(std::get<Mesh>(described.at(0).shape).corners_m.size() == 8);
  const std::string link = described.at(0).link;

  const auto boxed = torso("\"" + link + "\": {\"as\": \"box\"}");
  REQUIRE(boxed.size() == described.size());
  const Vec3 size_m = std::get<Box>(boxed[0].shape).size_m;
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(size_m[i] == doctest::Approx(0.1 * static_cast<double>(i + 1)));
    CHECK(boxed[0].pose.position_m[i] - described[0].pose.position_m[i] == doctest::Approx(size_m[i] / 2));
  }
  CHECK(std::holds_alternative<Box>(boxed[1].shape));  // the waist stays

  CHECK(torso("\"" + link + "\": {\"as\": \"nothing\"}").size() < described.size());
  const auto given = torso("\"" + link + "\": {\"meshes\": [\"" + file + "\", \"" + file + "\"]}");
  const auto of_link = std::ranges::count(described, link, &Geometry::link);
  REQUIRE(static_cast<std::ptrdiff_t>(given.size()) == static_cast<std::ptrdiff_t>(described.size()) - of_link + 2);
  CHECK(std::get<Mesh>(given.back().shape).file == file);
  CHECK(std::get<Mesh>(given.back().shape).corners_m.size() == 8);

  const std::string wrong = meshes.write("text.stl", "a letter");
  for (const auto& [collisions, message] :
       {std::pair{std::string(R"("chest": {})"), std::string("'chest'")},
        {"\"" + link + "\": {\"meshes\": [\"" + wrong + "\"]}", "cannot be read as a mesh"},
        {"\"" + link + "\": {\"meshes\": [\"/none.stl\"]}", "/none.stl"},
        {"\"" + link + "\": {\"as\": \"ball\"}", "ball"}}) {
    const std::string& text = collisions;  // clang 14 hands on no names of a structured binding
    CAPTURE(text);
    try {
      (void)read(text);
      FAIL_CHECK("it is taken");
    } catch (const InputError& error) {
      CHECK(std::string(error.what()).find(message) != std::string::npos);
      CHECK(error.problems().front().line > 0);
    }
  }
}

}  // namespace kadans
