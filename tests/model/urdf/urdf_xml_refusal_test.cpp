// Texts that are no URDF at all: each row a mistake, and the exact message it gives.
#include <doctest/doctest.h>

#include "broken_urdf.h"

using namespace kadans;

TEST_CASE("A text that is not XML, or not a URDF, is refused where it stops being one") {
  const std::vector<BrokenUrdf> table{
      {"tag closed by another", R"(    </inertial>
    <visual>)",
       R"(    </inertia>
    <visual>)",
       "duo.urdf:7:5: </inertia> where </inertial> was expected, for the <inertial> of line 4"},
      {"tag not closed", R"(</robot>
)",
       "", "duo.urdf:1:1: <robot> is not closed: the file ends before </robot>"},
      {"attribute without quotes", R"(radius="0.1")", "radius=0.1",
       "duo.urdf:8:31: the value of attribute 'radius' is not in quotes"},
      {"attribute without its closing quote", R"(radius="0.1")", R"(radius="0.1)",
       "duo.urdf:8:31: the value of attribute 'radius' has no closing quote"},
      {"attribute twice", R"(radius="0.1")", R"(radius="0.1" radius="0.2")",
       "duo.urdf:8:44: attribute 'radius' is given twice in <sphere>"},
      {"comment not closed", R"(<link name="fore_arm">)", R"(<!-- <link name="fore_arm">)",
       "duo.urdf:14:3: this comment is not closed by '-->'"},
      {"second root", "</robot>", R"(</robot><robot name="uno"/>)",
       "duo.urdf:27:9: a second root element, <robot>: a URDF has one"},
      {"text after the end", "</robot>", "</robot> end", "duo.urdf:27:10: text outside of the root element"},
      {"document type", R"(<robot name="duo">)", R"(<!DOCTYPE robot [<!ENTITY a "aaaa">]><robot name="duo">)",
       "duo.urdf:1:1: document type declarations have no place in a URDF"},
  };
  for (const BrokenUrdf& broken : table) check_told(broken);
}

TEST_CASE("A whole text that is not a URDF is refused") {
  CHECK(read_error(R"(<mujoco model="duo"/>)") ==
        "duo.urdf:1:1: the root element is <mujoco>, a URDF's is <robot>");                 // another root element
  CHECK(read_error(R"(# Kadans
)") == "duo.urdf:1:1: text outside of the root element");                                   // no element at all
  CHECK(read_error(R"(<!-- nothing -->
)") == R"(duo.urdf:1:1: no element in this file: a URDF starts with <robot name="...">)");  // only a comment
  CHECK(read_error("</robot>") ==
        "duo.urdf:1:1: </robot> closes nothing: no element is open here");                    // closing tag first
  CHECK(read_error("") == "duo.urdf: the file is empty");                                     // empty
  CHECK(read_error(R"(<robot name="empty"/>)") == "duo.urdf:1:1: this robot has no <link>");  // robot without links
}
