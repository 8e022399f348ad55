// docs/behaviors.md is true: its files are written into a copy of the project, its commands are run there, and what it
// shows is what they print.
#include <algorithm>

#include <doctest/doctest.h>

#include "app/document.h"

using namespace kadans;

TEST_CASE("every file of the guide is right, every command of it works and prints what it shows") {
  document::check_page("behaviors.md", "guide");
}

TEST_CASE("the guide is short") {
  const std::string guide = program::read(KADANS_SOURCE_DIR "/docs/behaviors.md");
  CHECK(std::count(guide.begin(), guide.end(), '\n') < 480);
}
