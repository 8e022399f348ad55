// What strangers do to the live server over its port, and that it serves the next one all the same.
#include "remote/page/live_server.h"

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include "remote/live_instance.h"
#include "remote/web_client.h"

namespace live_server_test {

using namespace kadans;
using namespace kadans::remote_test;

namespace {

constexpr const char* token = "secret";
constexpr const char* urdf = "/asset/robot.urdf";

struct Served {
  LiveInstance live;
  LiveHub hub{{.instance = live.instance,
               .port = live.instance.open_port(),
               .texts = {.name = "bench", .urdf = "<robot name=\"bench\"/>", .description = "{}"},
               .urdf_file = "bench.urdf",
               .timing = {}}};
  LiveServer server;

  explicit Served(std::vector<std::string> hosts = {})
      : server({.address = "127.0.0.1", .port = 0, .token = token, .hosts = std::move(hosts)}, &hub) {
    server.start();
  }
  std::uint16_t port() const { return server.port(); }
  std::string host() const { return "127.0.0.1:" + std::to_string(port()); }
  bool serves() const { return WebClient(port()).get(urdf, host()) == 200; }
};

std::string nested(std::size_t deep) { return std::string(deep, '[') + std::string(deep, ']'); }

std::string service_call(const std::string& json) {
  return std::string("\x02\x01\x00\x00\x00\x05\x00\x00\x00\x04\x00\x00\x00json", 17) + json;
}

// The next text that has it.
std::string hear_of(WebClient& client, const std::string& what) {
  for (std::optional<std::string> said = client.hear(); said; said = client.hear()) {
    if (said->find(what) != std::string::npos) return *said;
  }
  return "";
}

}  // namespace

TEST_CASE("a frame that is half a UTF-8 character ends no live server") {
  const Served served;
  WebClient client(served.port());
  REQUIRE(client.upgrade("/", served.host()) == 101);
  CHECK(client.say("\xC3"));
  CHECK(client.ended());  // the protocol of WebSockets refuses it before us
  WebClient quoted(served.port());
  REQUIRE(quoted.upgrade("/", served.host()) == 101);
  CHECK(quoted.say("\"\\ud800\""));  // half of a pair
  CHECK(hear_of(quoted, "not understood").find("ud800") == std::string::npos);
  CHECK(served.serves());
}

TEST_CASE("a service call that is no UTF-8 is refused to whoever has no token, unread, and answered to who has it") {
  const Served served;
  WebClient reader(served.port());
  REQUIRE(reader.upgrade("/", served.host()) == 101);
  CHECK(reader.say(service_call("\xFF"), true));
  CHECK(hear_of(reader, "serviceCallFailure").find("need the token") != std::string::npos);
  WebClient writer(served.port());
  REQUIRE(writer.upgrade("/?token=secret", served.host()) == 101);
  CHECK(writer.say(service_call("\xFF"), true));
  CHECK(hear_of(writer, "serviceCallFailure").find("not understood") != std::string::npos);
  CHECK(served.serves());
}

TEST_CASE("values nested deep in a message end no live server") {
  const Served served;
  for (const bool trusted : {false, true}) {
    CAPTURE(trusted);
    WebClient client(served.port());
    REQUIRE(client.upgrade(trusted ? "/?token=secret" : "/", served.host()) == 101);
    CHECK(client.say(R"({"op":"getParameters","parameterNames":[],"id":)" + nested(20'000) + "}"));
    CHECK(hear_of(client, "nested deeper than 64") != "");
    (void)client.say(R"({"op":"getParameters","parameterNames":[],"id":)" + nested(200'000) + "}");
    CHECK((trusted ? hear_of(client, "nested deeper than 64") != "" : client.ended()));  // too long without the token
  }
  CHECK(served.serves());
}

TEST_CASE("who calls the live server by another's name is refused without the token") {
  const Served served;
  for (const char* host :
       {"evil.example:1", "evil.example", "127.0.0.1.evil.example", "localhost.", "[::1", "", "10.0.0.1"}) {
    CAPTURE(host);
    CHECK(WebClient(served.port()).get(urdf, host) == 403);
    CHECK(WebClient(served.port()).upgrade("/", host, std::string("Origin: http://") + host + "\r\n") == 403);
    CHECK(WebClient(served.port()).get("/asset/robot.urdf?token=secret", host) == 200);
  }
  const std::string port = ":" + std::to_string(served.port());
  for (const std::string& host :
       {"127.0.0.1" + port, "localhost" + port, std::string("LOCALHOST:1"), "[::1]" + port, std::string("localhost")}) {
    CAPTURE(host);
    CHECK(WebClient(served.port()).get(urdf, host) == 200);
    CHECK(WebClient(served.port()).upgrade("/", host, "Origin: http://" + host + "\r\n") == 101);
    CHECK(WebClient(served.port()).upgrade("/", host, "Origin: http://localhost:9\r\n") == 403);
  }
  WebClient refused(served.port());
  CHECK(refused.get(urdf, "robot.local") == 403);
  CHECK(refused.body().find("--live-host") != std::string::npos);
  const Served named({"Robot.local"});
  CHECK(WebClient(named.port()).get(urdf, "robot.LOCAL:8765") == 200);
  CHECK(WebClient(named.port()).upgrade("/", "robot.local:1", "Origin: http://robot.local:1\r\n") == 101);
}

TEST_CASE("the live server answers a request by its head and waits for no body that it does not want") {
  const Served served;
  for (const char* line :
       {"POST /frames/a HTTP/1.1", "POST / HTTP/1.1", "PUT /x HTTP/1.1", "GET /asset/robot.urdf HTTP/1.1"}) {
    CAPTURE(line);
    WebClient client(served.port());
    CHECK(client.send(std::string(line) + "\r\nHost: " + served.host() + "\r\nContent-Length: 67108864\r\n\r\n"));
    const int status = client.status();
    CHECK(status >= 400);
    CHECK(status < 500);
    CHECK(client.ended());
  }
  WebClient endless(served.port());
  std::string head = "GET / HTTP/1.1\r\nHost: x\r\nX: ";
  CHECK(endless.send(head.append(100'000, 'x')));
  CHECK(endless.ended());
  CHECK(served.serves());
}

TEST_CASE("connections that strangers hold open keep neither the operator nor a page out of the live server") {
  const Served served;
  std::vector<std::unique_ptr<WebClient>> strangers;
  const auto half_open = [&] {
    strangers.push_back(std::make_unique<WebClient>(served.port()));
    (void)strangers.back()->send("GET / HTTP/1.1\r\n");
  };
  for (int i = 0; i < 300; ++i) half_open();
  CHECK(served.serves());
  for (std::size_t i = 0; i < LiveServer::readers_max; ++i) {
    strangers.push_back(std::make_unique<WebClient>(served.port()));
    CHECK(strangers.back()->upgrade("/", served.host()) == 101);
  }
  for (int i = 0; i < 300; ++i) half_open();
  CHECK(served.serves());
  WebClient page(served.port());
  CHECK(page.upgrade("/", served.host()) == 101);
  WebClient operates(served.port());
  REQUIRE(operates.upgrade("/?token=secret", served.host()) == 101);
  CHECK(hear_of(operates, "\"writes\":\"yes\"") != "");
}

TEST_CASE("the live server serves on when the process is out of descriptors") {
  const Served served;
  std::vector<std::unique_ptr<WebClient>> strangers;
  for (int i = 0; i < 8; ++i) {
    strangers.push_back(std::make_unique<WebClient>(served.port()));
    CHECK(strangers.back()->get(urdf, served.host()) == 200);  // it is accepted, and stays
  }
  rlimit before{};
  REQUIRE(getrlimit(RLIMIT_NOFILE, &before) == 0);
  const rlimit few{.rlim_cur = 256, .rlim_max = before.rlim_max};
  REQUIRE(setrlimit(RLIMIT_NOFILE, &few) == 0);
  std::vector<int> taken;
  for (int file = 0; (file = open("/dev/null", O_RDONLY | O_CLOEXEC)) >= 0;) taken.push_back(file);
  close(taken.back());  // the client's own; the server finds none
  taken.pop_back();
  WebClient next(served.port());
  CHECK(next.get(urdf, served.host()) == 200);
  for (const int file : taken) close(file);
  (void)setrlimit(RLIMIT_NOFILE, &before);
}

TEST_CASE("an exception while one connection is served ends that connection and nothing else") {
  LiveServer server({.address = "127.0.0.1", .port = 0, .token = token, .hosts = {}}, nullptr,
                    {.file = "", .take_frame = [](const std::string&, const std::string&) {
                       throw std::runtime_error("no place for it");
                     }});
  server.start();
  for (int i = 0; i < 3; ++i) {
    WebClient client(server.port());
    CHECK(client.send("POST /frames/a?token=secret HTTP/1.1\r\nHost: x\r\nContent-Length: 1\r\n\r\nx"));
    CHECK(client.status() == 0);
  }
  CHECK(WebClient(server.port()).get("/nothing", "localhost") >= 400);
}

TEST_CASE("a server of a record hands out the meshes that are found for it, and without any none") {
  const auto find = [](std::string_view name) {
    return name == "meshes/arm.stl" ? std::make_shared<const std::string>("solid") : nullptr;
  };
  for (const bool finds : {true, false}) {
    RecordSite site{.file = "", .take_frame = {}, .read_mesh = {}};
    if (finds) site.read_mesh = find;
    LiveServer server({.address = "127.0.0.1", .port = 0, .token = token, .hosts = {}}, nullptr, site);
    server.start();
    CHECK((WebClient(server.port()).get("/asset/meshes/arm.stl", "localhost") == 200) == finds);
    CHECK(WebClient(server.port()).get("/asset/meshes/leg.stl", "localhost") != 200);
  }
}

}  // namespace live_server_test
