#include "dap_stream.h"

#include <algorithm>
#include <cctype>
#include <cerrno>

#include <unistd.h>

#include "config/json/foreign_json.h"
#include "run_channel.h"
#include "signal/input_file.h"
#include "signal/number_text.h"

namespace kadans {
namespace {

constexpr std::size_t head_bytes_max = 1024, text_bytes_max = std::size_t{4} << 20U;

[[noreturn]] void refuse_bytes(const std::string& why) { refuse("debug adapter protocol", why); }

// The length that the head gives. A head with other fields is none of an editor: a web page, which may send what it
// likes to a port of this machine, cannot leave them out.
std::size_t length_in(std::string_view head) {
  constexpr std::string_view wanted = "content-length:";
  for (std::size_t begin = 0; begin < head.size();) {
    const std::size_t end = std::min(head.find("\r\n", begin), head.size());
    const std::string_view field = head.substr(begin, end - begin);
    begin = end + 2;
    std::string name(field.substr(0, wanted.size()));
    for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (!name.starts_with("content-")) refuse_bytes("a message begins without Content-Length");
    if (name != wanted) continue;
    const std::string_view digits = field.substr(std::min(field.find_first_not_of(' ', wanted.size()), field.size()));
    const auto length = number_of<std::size_t>(digits);
    if (!length) refuse_bytes("Content-Length is no number");
    if (*length > text_bytes_max) refuse_bytes("a message is longer than 4 MB");
    return *length;
  }
  refuse_bytes("a message begins without Content-Length");
}

}  // namespace

bool DapStream::read() {
  char part[16384];
  ssize_t got = 0;
  do got = ::read(in_, part, sizeof part);
  while (got < 0 && errno == EINTR);
  if (got <= 0) return false;
  taken_.append(part, static_cast<std::size_t>(got));
  return true;
}

std::optional<nlohmann::ordered_json> DapStream::next() {
  const std::size_t end = taken_.find("\r\n\r\n");
  if (std::min(end, taken_.size()) > head_bytes_max) refuse_bytes("a message begins without Content-Length");
  if (end == std::string::npos) return std::nullopt;
  const std::size_t length = length_in(std::string_view(taken_).substr(0, end)), begin = end + 4;
  if (taken_.size() < begin + length) return std::nullopt;
  std::optional<nlohmann::ordered_json> message = read_foreign_json(std::string_view(taken_).substr(begin, length));
  taken_.erase(0, begin + length);
  if (!message || !message->is_object()) refuse_bytes("a message is no JSON object");
  return message;
}

void DapStream::send(nlohmann::ordered_json message) {
  message["seq"] = ++sequence_;
  const std::string text = json_text(message);
  // When whoever reads is gone, read() will notice.
  (void)write_all(out_, "Content-Length: " + std::to_string(text.size()) + "\r\n\r\n" + text);
}

}  // namespace kadans
