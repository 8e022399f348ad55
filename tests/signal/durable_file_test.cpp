#include "signal/durable_file.h"

#include <fstream>
#include <iterator>

#include <doctest/doctest.h>

#include "kadans/signal/input_error.h"
#include "temporary_folder.h"

namespace durable_file_test {

using namespace kadans;
namespace fs = std::filesystem;

namespace {

std::string read(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace

TEST_CASE("A file is there whole, keeps its mode, and the link to it stays a link") {
  const test::TemporaryFolder folder;
  write_durably(folder.path() / "a", "one");
  fs::permissions(folder.path() / "a", fs::perms::owner_read | fs::perms::owner_write);
  fs::create_symlink("a", folder.path() / "link");
  fs::create_symlink("new", folder.path() / "ahead");
  write_durably(folder.path() / "link", "two");
  write_durably(folder.path() / "ahead", "three");
  CHECK(read(folder.path() / "a") == "two");
  CHECK(fs::is_symlink(folder.path() / "link"));
  CHECK((fs::status(folder.path() / "a").permissions() & fs::perms::all) ==
        (fs::perms::owner_read | fs::perms::owner_write));
  CHECK(read(folder.path() / "new") == "three");
  CHECK(std::distance(fs::directory_iterator(folder.path()), {}) == 4);  // nothing unfinished is left
}

TEST_CASE("A device is written to, not replaced, and what it does not take is told") {
  const test::TemporaryFolder folder;  // with links to devices: a program that replaces them takes the link
  for (const char* device : {"null", "full"}) fs::create_symlink(fs::path("/dev") / device, folder.path() / device);
  write_durably(folder.path() / "null", "gone");
  CHECK_THROWS_AS(write_durably(folder.path() / "full", "too much"), InputError);
  try {
    write_durably(folder.path() / "full", "too much");
  } catch (const InputError& error) {
    CHECK(std::string(error.what()).ends_with("/full: cannot be written: No space left on device"));
  }
  CHECK(fs::is_symlink(folder.path() / "null"));
  CHECK(fs::is_symlink(folder.path() / "full"));
}

TEST_CASE("A place that is none is refused with its name, and nothing is left there") {
  const test::TemporaryFolder folder;
  fs::create_directory(folder.path() / "taken");
  for (const char* name : {"nowhere/a", "taken"}) {
    CAPTURE(name);
    CHECK_THROWS_AS(write_durably(folder.path() / name, "x"), InputError);
  }
  CHECK(std::distance(fs::directory_iterator(folder.path()), {}) == 1);
}

}  // namespace durable_file_test
