#include "live_connection.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

#include <boost/asio/buffer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>

#include "kadans/remote/live_client.h"
#include "kadans/remote/page_files.h"

namespace kadans {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using Request = http::request<http::string_body>;
using Error = beast::error_code;

constexpr std::array subprotocols{std::string_view("foxglove.sdk.v1"), std::string_view("foxglove.websocket.v1")};
constexpr std::size_t request_max_bytes = std::size_t{64} << 20U;  // a frame that was drawn
constexpr std::size_t message_max_bytes = std::size_t{1} << 20U;
constexpr int send_buffer_bytes = 256 * 1024;  // of the system, for a client that does not read
constexpr std::chrono::seconds request_time{30};

std::string_view view(beast::string_view text) { return {text.data(), text.size()}; }

std::string_view path_of(std::string_view target) { return target.substr(0, target.find('?')); }

std::string_view query(std::string_view target, std::string_view key) {
  std::size_t at = target.find('?');
  while (at != std::string_view::npos) {
    const std::size_t end = target.find('&', at + 1);
    const std::string_view pair = target.substr(at + 1, end == std::string_view::npos ? end : end - at - 1);
    const std::size_t equals = pair.find('=');
    if (pair.substr(0, equals) == key) return equals == std::string_view::npos ? "" : pair.substr(equals + 1);
    at = end;
  }
  return {};
}

// All characters are looked at, so that the time tells nothing.
bool same(std::string_view a, std::string_view b) noexcept {
  unsigned difference = a.size() == b.size() ? 0U : 1U;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    difference |= static_cast<unsigned>(static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]));
  return difference == 0 && !b.empty();
}

std::string_view media_type(std::string_view path) {
  const std::string_view kind = path.substr(std::min(path.size(), path.rfind('.')));
  if (kind == ".html") return "text/html; charset=utf-8";
  if (kind == ".js") return "text/javascript";
  if (kind == ".css") return "text/css";
  if (kind == ".urdf") return "application/xml";
  return "application/octet-stream";
}

// The best of those that the client offers; "": none that is known.
std::string_view chosen_subprotocol(std::string_view offered) {
  for (const std::string_view known : subprotocols) {
    if (offered.find(known) != std::string_view::npos) return known;
  }
  return {};
}

// A browser says from which site its page came: ours, or one that must know the token.
bool from_elsewhere(const Request& request) {
  const std::string_view origin = view(request[http::field::origin]);
  if (origin.empty()) return false;
  const std::size_t slashes = origin.find("//");
  return slashes == std::string_view::npos || origin.substr(slashes + 2) != view(request[http::field::host]);
}

class Connection final : public LiveConnection {
 public:
  Connection(asio::ip::tcp::socket socket, const LiveSite& site, std::uint64_t id)
      : stream_(std::move(socket)), site_(site), id_(id) {}

  void start() override {
    Error ignored;
    beast::get_lowest_layer(stream_).socket().set_option(asio::socket_base::send_buffer_size(send_buffer_bytes),
                                                         ignored);
    beast::get_lowest_layer(stream_).socket().set_option(asio::ip::tcp::no_delay(true), ignored);
    read_request();
  }
  void beat() override {
    if (!client_) return;
    client_->tell_changes();
    pump();
  }
  void close() override {
    if (closed_) return;
    closed_ = true;
    beast::get_lowest_layer(stream_).close();
  }
  bool over() const noexcept override { return closed_ && under_way_ == 0; }
  bool is_client() const noexcept override { return client_ != nullptr && !closed_; }

 private:
  // Counts the operation until its handler is through.
  template <typename Handler>
  auto counted(Handler handler) {
    ++under_way_;
    return [this, handler](const Error& error, std::size_t = 0) {
      --under_way_;
      if (error) return close();
      if (!closed_) handler();
    };
  }

  void read_request() {
    parser_.emplace();
    parser_->body_limit(request_max_bytes);
    beast::get_lowest_layer(stream_).expires_after(request_time);
    http::async_read(stream_.next_layer(), buffer_, *parser_, counted([this] { take_request(parser_->get()); }));
  }

  void take_request(const Request& request) {
    const std::string_view target = view(request.target()), path = path_of(target);
    const bool writes = same(query(target, "token"), site_.token);
    if (websocket::is_upgrade(request)) return upgrade(request, writes);
    if (from_elsewhere(request) && !writes) return refuse(http::status::forbidden, "another site needs the token\n");
    if (request.method() == http::verb::post && path.starts_with("/frames/")) {
      if (!writes || !site_.record.take_frame) return refuse(http::status::forbidden, "the token is needed\n");
      site_.record.take_frame(std::string(path.substr(8)), request.body());
      return reply(http::status::ok, "text/plain", "");
    }
    if (request.method() != http::verb::get) return refuse(http::status::method_not_allowed, "only GET\n");
    if (path == "/record.mcap" && !site_.record.file.empty()) return send_record();
    if (site_.hub != nullptr && path.starts_with("/asset/")) return send_asset(path.substr(7));
    send_page(path == "/" ? "/index.html" : path);
  }

  void send_page(std::string_view path) {
    if (page_files().empty()) return refuse(http::status::service_unavailable, std::string(page_is_missing));
    const auto found = std::ranges::find(page_files(), path, &PageFile::path);
    if (found == page_files().end()) return refuse(http::status::not_found, "there is no such file\n");
    const std::string body(reinterpret_cast<const char*>(found->gzip.data()), found->gzip.size());
    reply(http::status::ok, media_type(path), body, true);
  }

  void send_asset(std::string_view name) {
    const std::optional<std::string> content = site_.hub->assets().read(name);
    if (!content) return refuse(http::status::not_found, "there is no such asset\n");
    reply(http::status::ok, media_type(name), *content);
  }

  void send_record() {
    Error error;
    http::file_body::value_type body;
    body.open(site_.record.file.c_str(), beast::file_mode::scan, error);
    if (error) return refuse(http::status::not_found, "the record cannot be read\n");
    file_.emplace(std::piecewise_construct, std::make_tuple(std::move(body)), std::make_tuple(http::status::ok, 11));
    file_->set(http::field::content_type, "application/octet-stream");
    file_->prepare_payload();
    beast::get_lowest_layer(stream_).expires_never();
    http::async_write(stream_.next_layer(), *file_, counted([this] { file_.reset(), read_request(); }));
  }

  void refuse(http::status status, const std::string& why) { reply(status, "text/plain; charset=utf-8", why); }

  void reply(http::status status, std::string_view type, const std::string& body, bool gzip = false) {
    response_ = {};
    response_.result(status);
    response_.version(11);
    response_.set(http::field::content_type, beast::string_view(type.data(), type.size()));
    response_.set(http::field::cache_control, "no-cache");
    response_.set("X-Content-Type-Options", "nosniff");
    response_.set("Referrer-Policy", "no-referrer");
    if (gzip) response_.set(http::field::content_encoding, "gzip");
    response_.body() = body;
    response_.prepare_payload();
    http::async_write(stream_.next_layer(), response_, counted([this] { read_request(); }));
  }

  void upgrade(const Request& request, bool writes) {
    const std::string_view subprotocol = chosen_subprotocol(view(request[http::field::sec_websocket_protocol]));
    if (site_.hub == nullptr) return refuse(http::status::not_found, "nothing runs here\n");
    if (subprotocol.empty()) return refuse(http::status::bad_request, "foxglove.sdk.v1 or foxglove.websocket.v1\n");
    if (from_elsewhere(request) && !writes) return refuse(http::status::forbidden, "another site needs the token\n");
    beast::get_lowest_layer(stream_).expires_never();
    stream_.set_option(websocket::stream_base::timeout::suggested(beast::role_type::server));
    stream_.set_option(websocket::stream_base::decorator([subprotocol](websocket::response_type& response) {
      response.set(http::field::sec_websocket_protocol, beast::string_view(subprotocol.data(), subprotocol.size()));
    }));
    stream_.read_message_max(message_max_bytes);
    stream_.auto_fragment(false);  // a message is one write of the system
    stream_.async_accept(request, counted([this, writes] { become_client(writes); }));
  }

  void become_client(bool writes) {
    Error ignored;
    const auto peer = beast::get_lowest_layer(stream_).socket().remote_endpoint(ignored);
    client_ = std::make_unique<LiveClient>(*site_.hub, id_, writes, "the page at " + peer.address().to_string());
    buffer_.consume(buffer_.size());
    read_message();
    pump();
  }

  void read_message() {
    stream_.async_read(buffer_, counted([this] { take_message(); }));
  }

  void take_message() {
    const auto data = buffer_.cdata();
    const auto* bytes = static_cast<const std::byte*>(data.data());
    if (stream_.got_text()) {
      client_->text({reinterpret_cast<const char*>(bytes), data.size()});
    } else {
      client_->binary({bytes, data.size()});
    }
    buffer_.consume(buffer_.size());
    if (client_->hopeless()) return close();
    read_message();
    pump();
  }

  // One message at a time is on its way; what is newest then is the next.
  void pump() {
    if (closed_ || writing_) return;
    if (client_->hopeless()) return close();
    if (!client_->next(outgoing_)) return;
    writing_ = true;
    stream_.binary(outgoing_.binary);
    stream_.async_write(asio::buffer(outgoing_.bytes.data(), outgoing_.bytes.size()), counted([this] {
                          writing_ = false;
                          pump();
                        }));
  }

  websocket::stream<beast::tcp_stream> stream_;
  const LiveSite& site_;
  std::uint64_t id_;
  beast::flat_buffer buffer_;
  std::optional<http::request_parser<http::string_body>> parser_;
  http::response<http::string_body> response_;
  std::optional<http::response<http::file_body>> file_;
  std::unique_ptr<LiveClient> client_;
  LiveClient::Outgoing outgoing_;
  bool writing_ = false, closed_ = false;
  int under_way_ = 0;
};

}  // namespace

std::unique_ptr<LiveConnection> make_live_connection(asio::ip::tcp::socket socket, const LiveSite& site,
                                                     std::uint64_t id) {
  return std::make_unique<Connection>(std::move(socket), site, id);
}

}  // namespace kadans
