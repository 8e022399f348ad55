// Names of xacro that a URDF has left: the values that are put in, and where they are not.
#include "model/urdf/xacro_values.h"

#include <cstdlib>
#include <string>

#include <doctest/doctest.h>

#include "kadans/model/urdf.h"

namespace kadans {
namespace {

std::string with_values(const std::string& values, const std::string& length) {
  return "<robot name=\"a\" xmlns:xacro=\"http://ros.org/wiki/xacro\">\n" + values +
         "\n<!-- <xacro:include filename=\"none\"/> -->\n<link name=\"base\"><visual><geometry><sphere radius=\"" +
         length + "\"/></geometry></visual></link></robot>";
}

std::string radius(const std::string& values, const std::string& length) {
  const auto found = with_xacro_values(with_values(values, length), "a.urdf");
  if (!found) return "nothing";
  const std::size_t at = found->text.find("radius=\"") + 8;
  return found->text.substr(at, found->text.find('"', at) - at);
}

}  // namespace

TEST_CASE("Names of xacro become their defaults, properties and what the environment has") {
  setenv("KADANS_TEST_RADIUS", "0.7", 1);
  setenv("KADANS_TEST_ODD", "<&\"", 1);
  CHECK(radius("<xacro:arg name=\"r\" default=\"0.5\"/>", "$(arg r)") == "0.5");
  CHECK(radius("<xacro:arg\n name=\"r\" default=\"0.5\"/>\n<xacro:property name=\"s\" value=\"$(arg r)\"/>", "${s}") ==
        "0.5");
  CHECK(radius("", "$(optenv KADANS_TEST_NONE 0.1 0.2)") == "0.1 0.2");
  CHECK(radius("", "$(optenv KADANS_TEST_RADIUS 0.1)") == "0.7");
  CHECK(radius("", "$(env KADANS_TEST_RADIUS)") == "0.7");
  CHECK(radius("", "1$(env KADANS_TEST_ODD)2") == "1&lt;&amp;&quot;2");
  CHECK(radius("<xacro:arg name=\"r\" default=\"0.5\"/>", "$(arg s)") == "$(arg s)");
}

TEST_CASE("What is more than names of values is left to the program xacro") {
  CHECK(radius("", "0.5") == "nothing");
  CHECK(radius("", "${2 * 3}") == "nothing");
  CHECK(radius("<xacro:macro name=\"leg\"/><xacro:arg name=\"r\" default=\"1\"/>", "$(arg r)") == "nothing");
  CHECK(radius("<xacro:if value=\"1\"/><xacro:arg name=\"r\" default=\"1\"/>", "$(arg r)") == "nothing");
  CHECK(radius("<xacro:property name=\"b\"><origin/></xacro:property>", "$(optenv NONE 1)") == "nothing");
  CHECK(!with_xacro_values("<robot", "a.urdf"));
  std::string growing = "<xacro:property name=\"v0\" value=\"0123456789\"/>";
  for (int i = 1; i < 60; ++i) {
    const std::string before = "${v" + std::to_string(i - 1) + "}";
    growing += "\n<xacro:property name=\"v" + std::to_string(i) + "\" value=\"" + before + before + "\"/>";
  }
  CHECK(radius(growing, "${v1}") == "nothing");
}

TEST_CASE("The text with its values is a URDF with each element in its line, and one message says what was taken") {
  const std::string text = with_values("<xacro:arg name=\"r\" default=\"0.5\"/>\n<xacro:arg name=\"no\"/>", "$(arg r)");
  const auto found = with_xacro_values(text, "a.urdf");
  REQUIRE(found);
  CHECK(found->told.text() == "a.urdf:5:53: values are put in for names of xacro: 'r' is '0.5' (its default)");
  const RobotModel model = read_urdf_text(found->text, "a.urdf");
  CHECK(std::get<Sphere>(model.links[0].visuals[0].shape).radius_m == 0.5);
}

}  // namespace kadans
