#include "kadans/plant/plant_type.h"

#include <map>

#include <doctest/doctest.h>

#include "kadans/signal/input_error.h"
#include "small_robots.h"

namespace kadans {
namespace {

// One of this program.
class BenchType final : public PlantType {
 public:
  std::string_view name() const noexcept override { return "bench"; }
  std::string_view doc() const noexcept override { return "of the test"; }
};
std::unique_ptr<PlantType> make_bench_type() { return std::make_unique<BenchType>(); }
KADANS_REGISTER_PLANT_TYPE(make_bench_type);

// Sets every number to the middle of its range.
class MiddleFields final : public PlantFields {
 public:
  void number(std::string_view name, double& value, Range range, std::string_view) override {
    CHECK(range.min < range.max);
    CHECK((value >= range.min && value <= range.max));
    seen[std::string(name)] = value = (range.min + range.max) / 2;
  }
  void integer(std::string_view, std::uint32_t&, Range, std::string_view) override {}
  void boolean(std::string_view, bool&, std::string_view) override {}
  void string(std::string_view name, std::string& value, std::string_view) override {
    seen[std::string(name)] = 0;
    value = "127.0.0.1:9";
  }
  void map(std::string_view, const ReadEntry&, std::string_view) override {}
  bool reading() const noexcept override { return true; }
  std::span<const std::string> drives() const noexcept override { return {}; }
  void refuse(std::string_view, const std::string& why) override { FAIL_CHECK(why); }
  std::map<std::string, double> seen;
};

}  // namespace

TEST_CASE("The types of plants are those whose folders stand in the tree, and those of the program") {
  CHECK(plant_type_names() == std::vector<std::string>{"bullet", "dynamixel", "hm2-eth", "ideal", "udp", "bench"});
  CHECK(plant_type_names(&PlantType::is_model) == std::vector<std::string>{"bullet", "ideal"});
  CHECK(plant_type_names(&PlantType::has_objects) == std::vector<std::string>{"bullet"});
  CHECK(plant_type_names(&PlantType::is_protocol) == std::vector<std::string>{"dynamixel", "hm2-eth", "udp"});
  for (const auto& type : plant_types()) CHECK(!type->doc().empty());
  CHECK_THROWS_AS((void)plant_type(plant_types(), "gone"), std::out_of_range);
}

TEST_CASE("A model makes a world, whatever is no model a plant, and each says so of what it does not make") {
  const test::Robot robot = test::pendulum(1, 0.5, 0.3);
  const PlantTypes types = plant_types();
  for (const std::string& name : plant_type_names(&PlantType::is_model)) {
    CAPTURE(name);
    const std::unique_ptr<World> world = plant_type(types, name).make_world({robot.model, robot.settings});
    SensorFrame sensors;
    world->robot(0).read(sensors);
    CHECK(sensors.joint_count == robot.model.joints.size());
    CHECK_THROWS_AS((void)plant_type(types, name).make_plant({}), std::logic_error);
  }
  CHECK_THROWS_AS((void)plant_type(types, "udp").make_world({robot.model, robot.settings}), std::logic_error);
  CHECK_THROWS_AS((void)plant_type(types, "udp").make_plant({}), InputError);  // knows no peer
  CHECK_THROWS_AS((void)plant_type(types, "bench").make_emulator({}, ""), std::logic_error);
}

TEST_CASE("A type's fields are its settings, and those of another robot stay as they were") {
  const PlantTypes types = plant_types(), others = plant_types();
  MiddleFields fields;
  const_cast<PlantType&>(plant_type(types, "udp")).fields(fields);
  CHECK(fields.seen.size() == 5);
  CHECK_NOTHROW((void)plant_type(types, "udp").make_plant({}));  // knows one now
  CHECK_THROWS_AS((void)plant_type(others, "udp").make_plant({}), InputError);
}

TEST_CASE("Types that others make come last") {
  class OtherType final : public PlantType {
   public:
    std::string_view name() const noexcept override { return "another"; }
    std::string_view doc() const noexcept override { return "of a plug-in"; }
  };
  const MakePlantType others[] = {[]() -> std::unique_ptr<PlantType> { return std::make_unique<OtherType>(); }};
  CHECK(plant_type_names(plant_types(others)) ==
        std::vector<std::string>{"bullet", "dynamixel", "hm2-eth", "ideal", "udp", "bench", "another"});
  CHECK(plant_type_names(plant_types(others), &PlantType::is_protocol) ==
        std::vector<std::string>{"dynamixel", "hm2-eth", "udp"});
}

TEST_CASE("Two types of one name are refused") {
  const MakePlantType again[] = {make_bench_type};
  CHECK_THROWS_WITH_AS(plant_types(again), "two types of plants have the name bench", std::invalid_argument);
  PlantTypes types = plant_types();
  CHECK_THROWS_WITH_AS(RegisteredPlantType::add_all(types), "two types of plants have the name bench",
                       std::invalid_argument);
}

}  // namespace kadans
