// Files as they should not be: missing, empty, a folder, binary, huge; and meshes beside the URDF.
#include <filesystem>
#include <string>

#include <doctest/doctest.h>

#include "broken_urdf.h"
#include "kadans/model/urdf.h"
#include "kadans/signal/input_error.h"
#include "temporary_folder.h"

using namespace kadans;

namespace {

std::string file_error(const std::string& file, const UrdfOptions& options = {}) {
  try {
    (void)read_urdf(file, options);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

std::string duo_with_mesh(const std::string& holder, const std::string& file) {
  const std::string shape = holder == "visual" ? R"(<sphere radius="0.1"/>)" : R"(<box size="0.1 0.2 0.3"/>)";
  return duo_with(shape, "<mesh filename=\"" + file + "\" scale=\"1 2 3\"/>");
}

}  // namespace

TEST_CASE("A file that is missing, a folder, empty or too large is refused by name") {
  const test::TemporaryFolder folder;
  CHECK(file_error(folder.path().string() + "/none.urdf") ==
        folder.path().string() + "/none.urdf: there is no such file");
  CHECK(file_error(folder.path().string()) == folder.path().string() + ": this is a folder, not a file");
  const std::string empty = folder.write("empty.urdf", "");
  CHECK(file_error(empty) == empty + ": the file is empty");
  const std::string huge = folder.write("huge.urdf", "<robot/>");
  std::filesystem::resize_file(huge, (2U << 20U) + 1);
  CHECK(file_error(huge) == huge + ": the file is larger than 2 MB");
  CHECK(file_error("/dev/null") == "/dev/null: this is no file but a device, a pipe or a socket");
}

TEST_CASE("Binary, other encodings and control characters are refused at the first byte that is no text") {
  using std::string_literals::operator""s;
  CHECK(read_error("<robot name=\"a\">\n\0</robot>"s) == "duo.urdf:2:1: a NUL byte: this is not a text file");
  CHECK(read_error("\x7F"
                   "ELF\x02\x01"s) == "duo.urdf:1:1: control character 0x7F in the text");
  CHECK(read_error("\xFF\xFE<\0r\0"s) == "duo.urdf:1:1: byte 0xFF is not UTF-8: save the file as UTF-8 text");
  CHECK(read_error("<!-- \xE9t\xE9 -->"s) == "duo.urdf:1:6: byte 0xE9 is not UTF-8: save the file as UTF-8 text");
  CHECK(read_error("<robot name=\"a\x1B[31m\"/>"s) == "duo.urdf:1:15: control character 0x1B in the text");
}

TEST_CASE("Columns count characters, not bytes, and a byte order mark does not disturb") {
  CHECK(read_error("\xEF\xBB\xBF<robot name=\"\xC3\xA9t\xC3\xA9\" vrsion=\"1.0\"/>").find("1:20: unknown attribute") !=
        std::string::npos);
  CHECK(read_error("\xEF\xBB\xBF" + duo_urdf) == "no error");
}

TEST_CASE("All mistakes of a file come in one error, by line, with places for machines") {
  std::string text = duo_with("\"0 1 0\"", "\"0 x 0\"");
  text.replace(text.find("\"2.5\""), 5, "\"2,5\"");
  text.replace(text.find("link=\"fore_arm\""), 15, "link=\"forearm\"");
  try {
    (void)read_urdf_text(text, "duo.urdf");
    FAIL("accepted");
  } catch (const InputError& error) {
    REQUIRE(error.problems().size() == 3);
    CHECK(error.problems()[0].line == 5);
    CHECK(error.problems()[0].column == 20);
    CHECK(error.problems()[1].line == 20);
    CHECK(error.problems()[2].line == 24);
    CHECK(error.problems()[2].file == "duo.urdf");
  }
}

TEST_CASE("What is odd is told beside the model, by place, and bounded") {
  std::string text =
      duo_with("<material name=\"orange\"/>", "<material name=\"orange\"><color rgba=\"0 0 1 1\"/></material>");
  text.replace(text.find("\"elbow\" type=\"revolute\""), 23, "\"elbow\" type=\"continuous\"");
  std::vector<InputProblem> warnings;
  const RobotModel model = read_urdf_text(text, "duo.urdf", {}, &warnings);
  REQUIRE(warnings.size() == 2);
  CHECK(warnings[0].text() == "duo.urdf:8:56: material 'orange' had another color before, which counts");
  CHECK(warnings[1].text() == "duo.urdf:25:5: joint 'elbow' is continuous: its 'lower' and 'upper' are not used");
  CHECK(model.links[0].visuals.at(0).color[0] == 1);
  CHECK(model.joints[1].type == JointType::continuous);

  const std::string visual =
      "<visual><geometry><sphere radius=\"1\"/></geometry><material name=\"orange\">"
      "<color rgba=\"0 0 1 1\"/></material></visual>";
  std::string visuals;
  for (int i = 0; i < 30; ++i) visuals += visual;
  (void)read_urdf_text(duo_with("<collision>", visuals + "<collision>"), "duo.urdf", {}, &warnings);
  REQUIRE(warnings.size() == 1);
  CHECK(warnings.back().text() ==
        "duo.urdf:9:54: material 'orange' had another color before, which counts (30 such in this line)");
  std::string kinds;
  for (int i = 0; i < 30; ++i) kinds += "<x" + std::to_string(i) + "/>";
  (void)read_urdf_text(duo_with("</robot>", kinds + "</robot>"), "duo.urdf", {}, &warnings);
  REQUIRE(warnings.size() == 26);
  CHECK(warnings.back().text() == "duo.urdf: and 5 more of other kinds");
  (void)read_urdf_text(duo_urdf, "duo.urdf", {}, &warnings);
  CHECK(warnings.empty());
}

TEST_CASE("Mesh files are found beside the URDF, and in a package's folder above it") {
  const test::TemporaryFolder folder;
  folder.write("duo/meshes/shell.stl", "solid");
  const std::string beside = folder.write("duo/urdf/a.urdf", duo_with_mesh("visual", "../meshes/shell.stl"));
  const std::string package =
      folder.write("duo/urdf/b.urdf", duo_with_mesh("visual", "package://duo/meshes/shell.stl"));
  const std::string absolute = folder.write(
      "duo/urdf/c.urdf", duo_with_mesh("visual", "file://" + folder.path().string() + "/duo/meshes/shell.stl"));
  for (const std::string& file : {beside, package, absolute}) {
    const RobotModel model = read_urdf(file);
    const auto& mesh = std::get<Mesh>(model.links[0].visuals.at(0).shape);
    CHECK(mesh.file == folder.path().string() + "/duo/meshes/shell.stl");
    CHECK(mesh.scale == Vec3{1, 2, 3});
  }
}

TEST_CASE(
    "A mesh collides as the hull that its reader gives, scaled; each file is read once, and a bad one is left out and "
    "told") {
  const test::TemporaryFolder folder;
  folder.write("hull.stl", "solid");
  const std::string file = folder.write("duo.urdf", duo_with_mesh("collision", "hull.stl"));
  CHECK(std::get<Mesh>(read_urdf(file).links[0].collisions.at(0).shape).corners_m.empty());
  int reads = 0;
  const MeshHull hull = [&](const std::string& mesh) {
    ++reads;
    CHECK(mesh == folder.path().string() + "/hull.stl");
    return std::vector<Vec3>{{1, 1, 1}, {-1, 0, 2}};
  };
  const RobotModel model = read_urdf(file, {.mesh_hull = hull});
  CHECK(std::get<Mesh>(model.links[0].collisions.at(0).shape).corners_m == std::vector<Vec3>{{1, 2, 3}, {-1, 0, 6}});
  CHECK(reads == 1);
  const MeshHull none = [](const std::string& mesh) -> std::vector<Vec3> {
    throw InputError({.file = mesh, .message = "cannot be read as a mesh"});
  };
  std::vector<InputProblem> warnings;
  CHECK(read_urdf(file, {.mesh_hull = none}, &warnings).links[0].collisions.empty());
  REQUIRE(warnings.size() == 1);
  CHECK(warnings[0].text() == file + ":9:42: mesh file '" + folder.path().string() +
                                  "/hull.stl' cannot be read as a mesh; link 'base' collides without it");
}
