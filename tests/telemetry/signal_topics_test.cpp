#include "telemetry/record/signal_topics.h"

#include <array>
#include <cmath>

#include <doctest/doctest.h>

#include "signal/byte_order.h"

using namespace kadans;

namespace {

const std::string line(80, '=');
const double zero = 0;

SignalTable table_of(const std::vector<Signal>& signals) {
  SignalTable table;
  for (const Signal& signal : signals) table.add(signal, &zero);
  return table;
}

}  // namespace

TEST_CASE("signal_topics nests the middle parts of the names and gathers each topic's signals in schema order") {
  const SignalTable table = table_of({{"joint.l_knee.position_rad", "rad", "Position."},
                                      {"base.tilt_rad", "rad", "Tilt."},
                                      {"joint.r_knee.position_rad", "rad", "Position."},
                                      {"joint.count", "", "Number of\njoints."},
                                      {"joint.l_knee.effort_Nm", "Nm", "Torque."}});
  const auto topics = signal_topics(table, Precision::full);
  REQUIRE(topics.size() == 2);
  CHECK(topics[0].topic == "/joint");
  CHECK(topics[0].type == "kadans_msgs/msg/Joint");
  CHECK(topics[0].signals == std::vector<SignalId>{0, 4, 2, 3});
  CHECK(topics[0].definition ==
        "kadans_msgs/JointLKnee l_knee\nkadans_msgs/JointRKnee r_knee\nfloat64 count  # [1] Number of joints.\n" +
            line +
            "\nMSG: kadans_msgs/JointLKnee\nfloat64 position_rad  # [rad] Position.\nfloat64 effort_nm  # [Nm] "
            "Torque.\n" +
            line + "\nMSG: kadans_msgs/JointRKnee\nfloat64 position_rad  # [rad] Position.\n");
  CHECK(topics[0].description ==
        "joint.l_knee.position_rad\trad\tPosition.\njoint.l_knee.effort_Nm\tNm\tTorque.\n"
        "joint.r_knee.position_rad\trad\tPosition.\njoint.count\t\tNumber of joints.\n");
  CHECK(topics[1].topic == "/base");
  CHECK(topics[1].signals == std::vector<SignalId>{1});
}

TEST_CASE("signal_topics makes names that ROS allows and keeps those apart that become the same") {
  const SignalTable table = table_of({{"2-legs.l--Knee", "", ""},
                                      {"2-legs._l_knee_", "", ""},
                                      {"2-legs.l-knee.q", "", ""},
                                      {"tick", "", ""},
                                      {"tick.late", "", ""}});
  const auto topics = signal_topics(table, Precision::single);
  REQUIRE(topics.size() == 2);
  CHECK(topics[0].topic == "/n2_legs");
  CHECK(topics[0].definition ==
        "float32 l_knee  # [1] \nfloat32 l_knee_2  # [1] \nkadans_msgs/N2LegsLKnee3 l_knee_3\n" + line +
            "\nMSG: kadans_msgs/N2LegsLKnee3\nfloat32 q  # [1] \n");
  CHECK(topics[1].definition == "float32 value  # [1] \nfloat32 late  # [1] \n");
}

TEST_CASE("signal_topics gives each control object a topic of its own") {
  const auto topics = signal_topics(table_of({{"control.walk.phase", "", ""},
                                              {"control.step.l_knee.error_rad", "rad", ""},
                                              {"control.active", "", ""},
                                              {"control.walk.foot.height_m", "m", ""}}),
                                    Precision::full);
  REQUIRE(topics.size() == 3);
  CHECK(topics[0].topic == "/control/walk");
  CHECK(topics[0].type == "kadans_msgs/msg/ControlWalk");
  CHECK(topics[0].signals == std::vector<SignalId>{0, 3});
  CHECK(topics[0].description == "control.walk.phase\t\t\ncontrol.walk.foot.height_m\tm\t\n");
  CHECK(topics[1].topic == "/control/step");
  CHECK(topics[2].topic == "/control");
}

TEST_CASE("signal_topics gives two nested types of one name a number each") {
  const auto topics = signal_topics(table_of({{"a.b_c.x", "", ""}, {"a.b.c.x", "", ""}}), Precision::full);
  CHECK(topics[0].definition.find("kadans_msgs/ABC b_c\n") != std::string::npos);
  CHECK(topics[0].definition.find("kadans_msgs/ABC2 c\n") != std::string::npos);
}

TEST_CASE("write_cdr puts a little-endian head before the numbers, and read_cdr takes back what was written") {
  const std::array<double, 3> values{1.5, -2e300, std::nan("")};
  std::vector<std::byte> payload(cdr_bytes(values.size(), Precision::full));
  write_cdr(payload, values, Precision::full);
  CHECK(payload.size() == 28);
  CHECK(payload[1] == std::byte{1});
  std::array<double, 3> read{};
  REQUIRE(read_cdr(payload, read) == Precision::full);
  CHECK(read[0] == 1.5);
  CHECK(read[1] == -2e300);
  CHECK(std::isnan(read[2]));

  payload.resize(cdr_bytes(values.size(), Precision::single));
  write_cdr(payload, values, Precision::single);
  REQUIRE(read_cdr(payload, read) == Precision::single);
  CHECK(read[0] == 1.5);
  CHECK(std::isinf(read[1]));
}

TEST_CASE("read_cdr refuses a payload of another size or head") {
  std::vector<std::byte> payload(cdr_bytes(2, Precision::full));
  write_cdr(payload, std::array<double, 2>{1, 2}, Precision::full);
  std::array<double, 2> two{};
  std::array<double, 3> three{};
  CHECK_FALSE(read_cdr(payload, three).has_value());
  CHECK(read_cdr(payload, two) == Precision::full);
  payload[1] = std::byte{0};
  CHECK_FALSE(read_cdr(payload, two).has_value());
}
