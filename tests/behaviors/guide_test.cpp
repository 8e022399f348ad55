// docs/behaviors.md, the pages behaviors_composition.md, behaviors_events.md and behaviors_tasks.md, and reflexes.md
// are true: their files are written into a copy of the project, their commands are run there, and what they show is
// what these print.
#include <algorithm>

#include <doctest/doctest.h>

#include "app/shipped/document.h"

using namespace kadans;

TEST_CASE("every file of the guide is right, every command of it works and prints what it shows") {
  document::check_page("behaviors.md", "guide");
}

TEST_CASE("every file of the page on events from outside is right, every command works and prints what it shows") {
  document::check_page("behaviors_events.md", "events");
}

TEST_CASE("every file of the chapter on composing is right, every command of it works and prints what it shows") {
  document::check_page("behaviors_composition.md", "composition");
}

TEST_CASE("every file of the page on what charts mean is right") {
  document::check_page("behaviors_semantics.md", "semantics");
}

TEST_CASE("every file of the page on a behavior that lasts is right, every command works and prints what it shows") {
  document::check_page("behaviors_mission.md", "mission");
}

TEST_CASE("every file of the page on reflexes is right, every command of it works and prints what it shows") {
  document::check_page("reflexes.md", "reflexes");
}

TEST_CASE("every file of the page on tasks is right, every command of it works and prints what it shows") {
  document::check_page("behaviors_tasks.md", "tasks");
}

TEST_CASE("the guide is short") {
  const std::string guide = program::read(KADANS_SOURCE_DIR "/docs/behaviors.md");
  CHECK(std::count(guide.begin(), guide.end(), '\n') < 480);
}
