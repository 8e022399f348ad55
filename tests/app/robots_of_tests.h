// URDFs of robots that nobody has configured.
#pragma once

#include <array>
#include <cstdio>
#include <string>
#include <tuple>

namespace kadans::robots_of_tests {

inline std::string link(const std::string& name, double mass_kg, const std::string& shape, double com_z_m) {
  std::array<char, 400> text{};
  std::snprintf(text.data(), text.size(),
                "<link name=\"%s\"><inertial><origin xyz=\"0 0 %g\"/><mass value=\"%g\"/><inertia ixx=\"%g\" ixy=\"0\" "
                "ixz=\"0\" iyy=\"%g\" iyz=\"0\" izz=\"%g\"/></inertial>",
                name.c_str(), com_z_m, mass_kg, 0.01 * mass_kg, 0.01 * mass_kg, 0.01 * mass_kg);
  const std::string origin = com_z_m == 0 ? "" : "<origin xyz=\"0 0 " + std::to_string(com_z_m) + "\"/>";
  return text.data() +
         (shape.empty() ? "" : "<collision>" + origin + "<geometry>" + shape + "</geometry></collision>") + "</link>\n";
}

inline std::string joint(const std::string& name, const std::string& parent, const std::string& child,
                         const std::string& xyz, const std::string& axis, const std::string& range) {
  return "<joint name=\"" + name + "\" type=\"revolute\"><parent link=\"" + parent + "\"/><child link=\"" + child +
         "\"/><origin xyz=\"" + xyz + "\"/><axis xyz=\"" + axis + "\"/><limit " + range +
         " effort=\"60\" velocity=\"15\"/></joint>\n";
}

// Four legs of three joints, knees that bend backwards alone, balls as feet.
inline std::string quadruped() {
  std::string text = "<robot name=\"Spot Four\">\n" + link("trunk", 8, "<box size=\"0.5 0.2 0.1\"/>", 0);
  for (const auto& [leg, x, y] :
       {std::tuple{"fl", "0.2", 1}, {"fr", "0.2", -1}, {"rl", "-0.2", 1}, {"rr", "-0.2", -1}}) {
    const std::string n = leg, side = y > 0 ? "" : "-";
    text += link(n + "_hip", 0.5, "", 0) + link(n + "_thigh", 0.8, "<box size=\"0.04 0.04 0.16\"/>", -0.1) +
            link(n + "_calf", 0.3, "<sphere radius=\"0.02\"/>", -0.2);
    text += joint(n + "_abduct", "trunk", n + "_hip", std::string(x) + " " + side + "0.06 0", "1 0 0",
                  "lower=\"-0.8\" upper=\"0.8\"");
    text +=
        joint(n + "_swing", n + "_hip", n + "_thigh", "0 " + side + "0.08 0", "0 1 0", "lower=\"-1.5\" upper=\"3\"");
    text += joint(n + "_knee", n + "_thigh", n + "_calf", "0 0 -0.2", "0 1 0", "lower=\"-2.7\" upper=\"-0.6\"");
  }
  return text + "</robot>\n";
}

// Two wheels and a caster, and on top a mast that pans. The right wheel's axis points the other way.
inline std::string cart(const std::string& robot = "cart", const std::string& speed = "12") {
  std::string text = "<robot name=\"" + robot + "\">\n" + link("base", 4, "<box size=\"0.4 0.3 0.06\"/>", 0) +
                     link("ball", 0.1, "<sphere radius=\"0.03\"/>", 0) +
                     link("mast", 0.5, "<box size=\"0.04 0.04 0.3\"/>", 0.15) +
                     "<joint name=\"caster\" type=\"fixed\"><parent link=\"base\"/><child link=\"ball\"/>"
                     "<origin xyz=\"-0.15 0 -0.05\"/></joint>\n" +
                     joint("pan", "base", "mast", "0.05 0 0.03", "0 0 1", "lower=\"-2\" upper=\"2\"");
  for (const auto& [side, y, axis] : {std::tuple{"left", "0.18", "0 0 1"}, {"right", "-0.18", "0 0 -1"}}) {
    const std::string name = side;
    text += link(name + "-wheel", 0.3, "<cylinder radius=\"0.08\" length=\"0.03\"/>", 0) + "<joint name=\"" + name +
            "-axle\" type=\"continuous\"><parent link=\"base\"/><child link=\"" + name +
            "-wheel\"/><origin xyz=\"0.1 " + y + " 0\" rpy=\"-1.5707963 0 0\"/><axis xyz=\"" + axis +
            "\"/><limit effort=\"2\" velocity=\"" + speed + "\"/></joint>\n";
  }
  return text + "</robot>\n";
}

// Two legs of six joints with flat feet, and a heavy trunk.
inline std::string biped() {
  std::string text = "<robot name=\"biped\">\n" + link("pelvis", 12, "<box size=\"0.2 0.3 0.4\"/>", 0.2);
  for (const auto& [leg, side] : {std::pair{"l", ""}, {"r", "-"}}) {
    const std::string n = leg;
    text += link(n + "_yaw", 0.5, "", 0) + link(n + "_roll", 0.5, "", 0) +
            link(n + "_thigh", 2, "<cylinder radius=\"0.05\" length=\"0.2\"/>", -0.15) +
            link(n + "_shank", 1.5, "", -0.15) + link(n + "_pitch", 0.3, "", 0) +
            link(n + "_foot", 0.8, "<box size=\"0.22 0.1 0.03\"/>", -0.05);
    text += joint(n + "_hip_yaw", "pelvis", n + "_yaw", std::string("0 ") + side + "0.09 0", "0 0 1",
                  "lower=\"-1\" upper=\"1\"");
    text += joint(n + "_hip_roll", n + "_yaw", n + "_roll", "0 0 0", "1 0 0", "lower=\"-0.5\" upper=\"0.5\"");
    text += joint(n + "_hip_pitch", n + "_roll", n + "_thigh", "0 0 0", "0 1 0", "lower=\"-2\" upper=\"1\"");
    text += joint(n + "_knee", n + "_thigh", n + "_shank", "0 0 -0.3", "0 1 0", "lower=\"-0.05\" upper=\"2.4\"");
    text += joint(n + "_ankle_pitch", n + "_shank", n + "_pitch", "0 0 -0.3", "0 1 0", "lower=\"-1\" upper=\"1\"");
    text += joint(n + "_ankle_roll", n + "_pitch", n + "_foot", "0 0 0", "1 0 0", "lower=\"-0.5\" upper=\"0.5\"");
  }
  return text + "</robot>\n";
}

inline std::string arm() {
  std::string text = "<robot name=\"arm\">\n" + link("base", 3, "<box size=\"0.2 0.2 0.1\"/>", 0);
  std::string parent = "base";
  for (int i = 1; i <= 5; ++i) {
    const std::string n = std::to_string(i);
    text += link("part" + n, 2.5 / i, "<cylinder radius=\"0.03\" length=\"0.15\"/>", 0.12);
    text += joint("joint" + n, parent, "part" + n, i == 1 ? "0 0 0.1" : "0 0 0.25", i % 2 != 0 ? "0 0 1" : "0 1 0",
                  "lower=\"-2\" upper=\"2\"");
    parent = "part" + n;
  }
  return text + "</robot>\n";
}

// A joint that lifts its arm against gravity, nothing else.
inline std::string one_joint() {
  return "<robot name=\"lever\">\n<link name=\"world\"/>\n" + link("post", 2, "<box size=\"0.1 0.1 0.4\"/>", 0.2) +
         link("arm", 1, "<box size=\"0.04 0.04 0.3\"/>", 0.15) +
         "<joint name=\"foot\" type=\"fixed\"><parent link=\"world\"/><child link=\"post\"/></joint>\n" +
         joint("lift", "post", "arm", "0 0 0.4", "0 1 0", "lower=\"-1.5\" upper=\"1.5\"") + "</robot>\n";
}

}  // namespace kadans::robots_of_tests
