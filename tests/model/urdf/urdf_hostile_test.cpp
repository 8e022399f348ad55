// Input that wants to break the reader: every text is either a model or an InputError, and soon.
#include <algorithm>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

#include <doctest/doctest.h>

#include "broken_urdf.h"
#include "kadans/model/urdf.h"
#include "kadans/signal/input_error.h"
#include "kadans/signal/random.h"

using namespace kadans;

namespace {

std::string tulip_text() {
  std::ifstream in(KADANS_SOURCE_DIR "/models/tulip/tulip.urdf", std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

std::size_t below(RandomStream& random, std::size_t limit) {
  return static_cast<std::size_t>(random.next() % static_cast<std::uint64_t>(limit));
}

// One of six ways to hurt a text.
void mutate(std::string& text, RandomStream& random) {
  using std::string_view_literals::operator""sv;
  constexpr std::string_view spice = "<>/=\"' -.,0123456789einfax&;$\n\0\xFF"sv;
  const std::size_t at = below(random, text.size()), size = 1 + below(random, 40);
  switch (random.next() % 6) {
    case 0:
      text[at] = spice[below(random, spice.size())];
      break;
    case 1:
      text.insert(at, 1, spice[below(random, spice.size())]);
      break;
    case 2:
      text.erase(at, size);
      break;
    case 3:
      text.insert(at, text.substr(below(random, text.size()), size));
      break;
    case 4:
      if (random.next() % 8 == 0) text.resize(at + 1);
      break;
    default:
      text[at] = static_cast<char>(static_cast<unsigned char>(text[at]) ^ (1U << (random.next() % 8)));
  }
}

// A model as the rest of Kadans relies on it.
bool sound(const RobotModel& model) {
  if (model.links.size() != model.joints.size() + 1 || model.joints.size() > max_joints) return false;
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    const Joint& joint = model.joints[i];
    if (joint.parent > i || !(model.links[i + 1].inertia.mass_kg >= 0) || !(joint.lower_rad <= joint.upper_rad))
      return false;
  }
  return true;
}

std::string repeated(const std::string& piece, std::size_t times) {
  std::string text;
  text.reserve(piece.size() * times);
  for (std::size_t i = 0; i < times; ++i) text += piece;
  return text;
}

std::string robot_of(const std::string& content) {
  std::string text = R"(<robot name="a">)";
  text += content;
  text += "</robot>";
  return text;
}

// "l7" for ("l", 7).
std::string numbered(const char* name, int number) {
  std::string text = name;
  text += std::to_string(number);
  return text;
}

std::string joint_between(const char* type, int parent) {
  std::string text = "<joint name=\"";
  text += numbered("j", parent + 1);
  text += "\" type=\"";
  text += type;
  text += "\"><parent link=\"";
  text += numbered("l", parent);
  text += "\"/><child link=\"";
  text += numbered("l", parent + 1);
  text += "\"/></joint>\n";
  return text;
}

std::string snake(int joints, const char* type, const std::string& in_link) {
  std::string text;
  for (int i = 0; i <= joints; ++i) {
    text += "<link name=\"";
    text += numbered("l", i);
    text += "\">";
    text += in_link;
    text += "</link>\n";
  }
  for (int i = 0; i < joints; ++i) text += joint_between(type, i);
  return robot_of(text);
}

}  // namespace

TEST_CASE("A thousand mutations of the TULip's URDF are each a sound model or an error with a place") {
  const std::string original = tulip_text();
  RandomStream random(2008, "urdf mutations");
  int accepted = 0, refused = 0;
  for (int i = 0; i < 1000; ++i) {
    std::string text = original;
    for (std::uint64_t k = 0, n = 1 + random.next() % 3; k < n && !text.empty(); ++k) mutate(text, random);
    try {
      const RobotModel model = read_urdf_text(text, "mutant.urdf");
      ++accepted;
      CHECK(sound(model));
    } catch (const InputError& error) {
      ++refused;
      CHECK(error.problems().front().line > 0);
      CHECK(error.problems().size() <= 26);
    }
  }
  CHECK(accepted > 100);  // many hit a comment or a digit: a reader that refuses everything is no reader
  CHECK(refused > 100);
}

TEST_CASE("The TULip's URDF cut off anywhere is refused") {
  const std::string original = tulip_text();
  const std::size_t end = original.rfind("</robot>");
  for (std::size_t size = 1; size < end + 8; size += 97) {
    CHECK(read_error(original.substr(0, size)) != "no error");
  }
}

TEST_CASE("Elements nested very deep are refused where they get too deep") {
  CHECK(read_error(repeated("<a>", 600000)) == "duo.urdf:1:193: elements nested more than 64 deep");
  CHECK(read_error(robot_of(repeated("<gazebo>", 70))).find("nested more than 64") != std::string::npos);
}

TEST_CASE("An attribute of a megabyte is refused and not repeated") {
  const std::string megabyte(1000000, 'x');
  const std::string shown = "<mass> value 'xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx...' is not a number";
  CHECK(read_error(duo_with("2.5", megabyte)) == "duo.urdf:5:20: " + shown);
  CHECK(read_error(duo_with("fore_arm", megabyte)).size() < 500);
  CHECK(read_error(duo_with("0 1 0", repeated("0 ", 500000))).find("3 were expected") != std::string::npos);
}

TEST_CASE("Floods of elements, links and attributes are refused") {
  CHECK(read_error(robot_of(repeated("<x/>", 200000))).find("more than 100000 elements") != std::string::npos);
  CHECK(read_error(robot_of(repeated("<link name=\"a\"/>\n", 5000))).find("more than 1000 links") != std::string::npos);
  std::string robot = "<robot";
  for (int i = 0; i < 1000; ++i) robot += numbered(" a", i) + "=\"\"";
  CHECK(read_error(robot + "/>").find("too many attributes") != std::string::npos);
}

TEST_CASE("More than 25 kinds of mistakes stop the reading") {
  std::string links;
  for (int i = 0; i < 900; ++i) links += "<link " + numbered("nam", i) + "=\"x\"/>\n";
  const std::string error = read_error(robot_of(links));
  CHECK(std::count(error.begin(), error.end(), '\n') == 25);
  CHECK(error.ends_with("there may be more: reading stopped here"));
}

TEST_CASE("A robot may have 64 moving joints and not one more") {
  const std::string body =
      R"(<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>)";
  CHECK(read_error(snake(64, "continuous", body)) == "no error");
  CHECK(read_error(snake(65, "continuous", body)).find("more than 64 moving joints") != std::string::npos);
}

TEST_CASE("A thousand links fixed to each other are one body") {
  const RobotModel model = read_urdf_text(snake(999, "fixed", ""), "snake.urdf");
  CHECK(model.links.size() == 1);
  CHECK(model.links[0].merged.size() == 999);
}
