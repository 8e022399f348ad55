// Where instances are found, who may do what, what dead ones leave behind.
#include "remote/ctl/ctl_folder.h"

#include <cstdlib>
#include <fstream>

#include <doctest/doctest.h>
#include <grp.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include "kadans/signal/input_error.h"
#include "remote/live_instance.h"

namespace ctl_folder_test {

using namespace kadans;
using namespace kadans::remote_test;
namespace fs = std::filesystem;

namespace {

unsigned mode_of(const fs::path& file) {
  struct stat found {};
  return stat(file.c_str(), &found) == 0 ? found.st_mode & 0777U : 0;
}

std::string why_not(const CtlSockets::Settings& settings) {
  try {
    const CtlSockets sockets(settings);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

std::string why_no_link(const fs::path& where, Role role) {
  try {
    const CtlLink link(where, role);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("the sockets have a mode each by their role, and are gone with their instance") {
  const Project project;
  const fs::path folder = project.root / "ctl";
  {
    const CtlSockets sockets({.folder = folder});
    CHECK(mode_of(folder / "read") == 0666U);
    CHECK(mode_of(folder / "operate") == 0660U);
    CHECK(mode_of(folder / "develop") == 0600U);
    CHECK(mode_of(folder / "lock") == 0600U);  // who may read it may lock it, and so lock us out
  }
  CHECK_FALSE(fs::exists(folder / "read"));
  CHECK_FALSE(fs::exists(folder / "develop"));
  const group* own = getgrgid(getgid());
  if (own == nullptr) return;  // a group without a name
  const CtlSockets shared({.folder = folder, .operators = own->gr_name, .developers = own->gr_name});
  CHECK(mode_of(folder / "develop") == 0660U);
}

TEST_CASE("a folder serves one instance, what a dead one left is taken over, and mistakes are named") {
  const Project project;
  const fs::path folder = project.root / "ctl";
  {
    const CtlSockets first({.folder = folder});
    CHECK(has(why_not({.folder = folder}), "another instance is reached here already"));
    CHECK(fs::is_socket(folder / "read"));  // it is unharmed
  }
  const int left = ::socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string stale = (folder / "read").string();
  stale.copy(address.sun_path, sizeof address.sun_path - 1);
  REQUIRE(bind(left, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0);
  close(left);
  CHECK(has(why_no_link(folder, Role::read), "nobody listens: its instance died"));
  CHECK(why_not({.folder = folder}).empty());
  CHECK(has(why_not({.folder = folder, .operators = "nobody-is-in-it"}), "there is no group 'nobody-is-in-it'"));
  CHECK(has(why_not({.folder = project.root / std::string(120, 'x')}), "at most 107 characters"));
  std::ofstream(project.root / "file") << "x";
  CHECK_FALSE(why_not({.folder = project.root / "file"}).empty());
}

TEST_CASE("who finds no instance is told where it was looked for") {
  const Project project;
  CHECK(has(why_no_link(project.root / "none", Role::read),
            "no running instance found; looked in " + project.root.string()));
  const std::string all = why_no_link("", Role::operate);
  if (!all.empty()) CHECK((has(all, "/run/kadans") || has(all, "nobody listens")));
}

TEST_CASE("the usual place is that of the session, else the system's for root and one in tmp for others") {
  const char* before = std::getenv("XDG_RUNTIME_DIR");
  const std::string kept = before == nullptr ? "" : before;
  setenv("XDG_RUNTIME_DIR", "/run/user/7", 1);
  CHECK(ctl_folder_for_server() == "/run/user/7/kadans");
  CHECK(ctl_folders_for_clients().front() == "/run/user/7/kadans");
  CHECK(ctl_folders_for_clients().back() == "/run/kadans");
  unsetenv("XDG_RUNTIME_DIR");
  CHECK(ctl_folder_for_server() ==
        (getuid() == 0 ? fs::path("/run/kadans") : fs::path("/tmp/kadans-" + std::to_string(getuid()))));
  if (!kept.empty()) setenv("XDG_RUNTIME_DIR", kept.c_str(), 1);
}

TEST_CASE("each role may do what it is for and no more, and is told which it would need") {
  LiveInstance live;
  live.start();
  const auto needs = [&](const Json& request, Role role) { return live.ask(request, role).value("error", "none"); };
  CHECK(live.ask({{"verb", "status"}}, Role::read)["ok"] == true);
  CHECK(needs({{"verb", "stop"}}, Role::read) == "'stop' needs the role operate; this socket gives read");
  CHECK(needs({{"verb", "estop"}}, Role::read) == "'estop' needs the role operate; this socket gives read");
  CHECK(needs({{"verb", "stop"}}, Role::operate) == "none");
  CHECK(needs({{"verb", "undo"}}, Role::operate) == "'undo' needs the role develop; this socket gives operate");
  CHECK(needs({{"verb", "line"}, {"text", "1"}}, Role::operate) ==
        "'line' needs the role develop; this socket gives operate");
  CHECK(needs({{"verb", "line"}, {"text", "1"}}, Role::develop) == "none");
}

TEST_CASE("a client takes the lowest role that suffices, and the lock keeps out who may not") {
  LiveInstance live;
  live.start();
  CtlLink link(live.sockets.folder(), Role::read);
  link.send("{\"verb\":\"stop\"}");
  CHECK(has(link.receive(20'000).value(), "this socket gives read"));
  if (getuid() != 0) return;  // to become somebody else
  REQUIRE(chmod(live.project.root.c_str(), 0755) == 0);
  const pid_t child = fork();
  if (child == 0) {
    if (setgid(65534) != 0 || setuid(65534) != 0) _exit(9);
    const bool reads = why_no_link(live.sockets.folder(), Role::read).empty();
    const std::string denied = why_no_link(live.sockets.folder(), Role::operate);
    _exit(!reads ? 1 : !has(denied, "the role operate is for user root and group root") ? 2 : 0);
  }
  int status = 0;
  REQUIRE(waitpid(child, &status, 0) == child);
  if (WEXITSTATUS(status) != 9) CHECK(WEXITSTATUS(status) == 0);  // 9: this root may not become somebody else
}

}  // namespace ctl_folder_test
