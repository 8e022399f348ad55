// The pages of docs/ are true: their files are accepted, their commands work, and print what the pages show.
#include "document.h"

#include <doctest/doctest.h>

using namespace kadans;

TEST_CASE("docs/scenarios.md: every file is accepted, every command works and prints what is shown") {
  document::check_page("scenarios.md", "document_scenarios");
}

TEST_CASE("docs/supervisor.md: every file is accepted, every command works and prints what is shown") {
  document::check_page("supervisor.md", "document_supervisor");
}

TEST_CASE("docs/joystick.md: every file is accepted, every command works and prints what is shown") {
  document::check_page("joystick.md", "document_joystick");
}

TEST_CASE("docs/sweeps.md: every file is accepted, every command works and prints what is shown") {
  document::check_page("sweeps.md", "document_sweeps");
}
