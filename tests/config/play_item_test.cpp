// Lists of what to play, as people write them.
#include "config/scenario/play_item.h"

#include <doctest/doctest.h>

#include "kadans/signal/input_error.h"

namespace kadans::play_item_test {
namespace {

const PlayFolders folders{KADANS_SOURCE_DIR "/config/scenarios/squat.json", "tulip"};

std::string refusal(std::string_view text) {
  try {
    (void)read_play_items(text, "--play", folders);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("A list names behaviors of the robot, or files, with plain arguments") {
  const auto items =
      read_play_items("squat, wave{ swing_rad = 0.5 , times=-2e1,on=true, who='a, b' }, behaviors/tulip/squat.lua{}",
                      "--play", folders);
  REQUIRE(items.size() == 3);
  CHECK(items[0].file == KADANS_SOURCE_DIR "/behaviors/tulip/squat.lua");
  CHECK(items[0].arguments.empty());
  CHECK(items[1].file == KADANS_SOURCE_DIR "/behaviors/tulip/wave.lua");
  CHECK(items[1].place == TextPlace{1, 8});
  REQUIRE(items[1].arguments.size() == 4);
  CHECK(items[1].arguments[0].name == "swing_rad");
  CHECK(std::get<double>(items[1].arguments[0].value) == 0.5);
  CHECK(std::get<double>(items[1].arguments[1].value) == -20);
  CHECK(std::get<bool>(items[1].arguments[2].value));
  CHECK(std::get<std::string>(items[1].arguments[3].value) == "a, b");
  CHECK(items[1].arguments[1].place == TextPlace{1, 32});
  CHECK(items[2].file == items[0].file);
}

TEST_CASE("A bar begins a lane that plays at the same time") {
  const auto items = read_play_items("squat, squat | wave", "--play", folders);
  REQUIRE(items.size() == 3);
  CHECK(items[0].lane == 0);
  CHECK(items[1].lane == 0);
  CHECK(items[2].lane == 1);
}

TEST_CASE("What is wrong in a list is told with its position and what was meant") {
  const std::pair<const char*, const char*> wrong[] = {
      {"", "--play:1:1: what to play: wanted the name of a behavior, found the end"},
      {"squat,", "--play:1:7: what to play: wanted the name of a behavior, found the end"},
      {"squat wave", "--play:1:7: what to play: wanted a comma, or '{' and arguments, found 'w'"},
      {"squta", "--play:1:1: unknown behavior 'squta' in behaviors/tulip, did you mean 'squat'?"},
      {"squat{depth_m}", "--play:1:14: what to play: wanted '=' and a value, found '}'"},
      {"squat{depth_m=}", "--play:1:15: what to play: wanted a number, true, false or a text in quotes"},
      {"squat{depth_m=deep}",
       "--play:1:15: what to play: wanted a number, true, false or a text in quotes, found 'deep'"},
      {"squat{depth_m=0x10}",
       "--play:1:15: what to play: wanted a number, true, false or a text in quotes, found '0x10'"},
      {"squat{depth_m=1e999}",
       "--play:1:15: what to play: wanted a number, true, false or a text in quotes, found '1e999'"},
      {"squat{depth_m=nan}",
       "--play:1:15: what to play: wanted a number, true, false or a text in quotes, found 'nan'"},
      {"squat{depth_m=0.1", "--play:1:18: what to play: wanted a comma or '}', found the end"},
      {"squat{a=1, a=2}", "--play:1:12: what to play: argument 'a' stands twice"},
      {"squat{1a=1}", "--play:1:7: what to play: wanted the name of an argument"},
      {"squat{a='x}", "--play:1:9: what to play: this text has no end"},
  };
  for (const auto& [text, message] : wrong) {
    const std::string list = text;  // clang captures no structured binding
    CAPTURE(list);
    CHECK(refusal(list) == message);
  }
  CHECK(refusal("behaviors/tulip/squta.lua").find("--play:1:1: behavior: there is no file") == 0);
}

TEST_CASE("Every behavior of a list that is missing is told") {
  try {
    (void)read_play_items("squta, wave, waev", "--play", folders);
    FAIL("accepted");
  } catch (const InputError& error) {
    REQUIRE(error.problems().size() == 2);
    CHECK(error.problems()[1].column == 14);
  }
}

}  // namespace kadans::play_item_test
