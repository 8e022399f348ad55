// The last word to a plant: the control thread can no longer drive it, wherever it hangs.
#include "app/run/last_word.h"

#include <semaphore>
#include <thread>

#include <doctest/doctest.h>

using namespace kadans;

namespace {

// Notes what is written. The control thread can be held in it.
struct Noted final : Plant {
  void read(SensorFrame& sensors) noexcept override {
    sensors.joint_count = 1;
    ++reads;
  }
  void write(const ActuationFrame& actuation) noexcept override {
    if (holds) {
      inside.release();
      go_on.acquire();
    }
    written = actuation.joints[0].mode;
    ++writes;
  }

  int reads = 0, writes = 0;
  ActuationMode written = ActuationMode::position;
  bool holds = false;
  std::binary_semaphore inside{0}, go_on{0};
};

ActuationFrame frame(ActuationMode mode) {
  ActuationFrame frame;
  frame.joint_count = 1;
  frame.joints[0].mode = mode;
  return frame;
}

}  // namespace

TEST_CASE("After the last word the control thread reaches the plant no more") {
  Noted plant;
  LastWord last_word(plant);
  SensorFrame sensors;
  last_word.read(sensors);
  last_word.write(frame(ActuationMode::effort));
  CHECK(sensors.joint_count == 1);
  CHECK(plant.written == ActuationMode::effort);
  REQUIRE(last_word.say(frame(ActuationMode::off), 0));
  CHECK(plant.written == ActuationMode::off);
  last_word.read(sensors);
  last_word.write(frame(ActuationMode::effort));
  CHECK(plant.written == ActuationMode::off);
  CHECK(plant.reads == 1);
  CHECK(last_word.say(frame(ActuationMode::velocity), 0));  // no second one
  CHECK(plant.writes == 2);
}

TEST_CASE("While the control thread hangs in the plant there is no last word, and afterwards there is") {
  Noted plant;
  plant.holds = true;
  LastWord last_word(plant);
  std::thread control([&] { last_word.write(frame(ActuationMode::effort)); });
  plant.inside.acquire();
  CHECK_FALSE(last_word.say(frame(ActuationMode::off), 0));
  CHECK(plant.writes == 0);
  plant.holds = false;
  plant.go_on.release();
  CHECK(last_word.say(frame(ActuationMode::off), 60'000'000'000));
  control.join();
  CHECK(plant.written == ActuationMode::off);
  CHECK(plant.writes == 2);
}
