#include "html_page.h"

#include <cstdint>

namespace kadans {
namespace {

constexpr const char* page_style = R"css(
:root { color-scheme: light dark; --paper: #fefefe; --ink: #1c2833; --dim: #5b6875; --line: #d9e0e6; --card: #f4f6f8;
  --good: #1b7a3d; --bad: #c62828; --warn: #96690a; }
@media (prefers-color-scheme: dark) { :root { --paper: #12181e; --ink: #dde5ec; --dim: #93a1af; --line: #2a343e;
  --card: #1a222a; --good: #5cc98a; --bad: #ff8a80; --warn: #e0b252; } }
* { box-sizing: border-box; }
body { margin: 0 auto; padding: 28px 24px 64px; max-width: 1248px; background: var(--paper); color: var(--ink);
  font: 15px/1.5 system-ui, "DejaVu Sans", sans-serif; }
h1 { font-size: 26px; margin: 0 0 4px; } h2 { font-size: 18px; margin: 36px 0 10px; }
p { margin: 0 0 10px; max-width: 80ch; } .dim { color: var(--dim); }
.good { color: var(--good); } .bad { color: var(--bad); } .warn { color: var(--warn); }
.badge { display: inline-block; padding: 1px 12px; border: 2px solid; border-radius: 6px; font-weight: 700;
  letter-spacing: .04em; font-size: 18px; margin-right: 12px; vertical-align: 3px; }
table { border-collapse: collapse; } th { text-align: left; color: var(--dim); font-weight: 600; }
th, td { padding: 3px 18px 3px 0; border-bottom: 1px solid var(--line); vertical-align: top; }
td.number, th.number { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
td.mark { width: 1.6em; font-weight: 700; }
.scroll { overflow-x: auto; max-height: 480px; overflow-y: auto; }
code, pre { font: 13px/1.5 ui-monospace, "DejaVu Sans Mono", monospace; }
pre { background: var(--card); padding: 10px 14px; border-radius: 6px; overflow-x: auto; margin: 0 0 10px;
  white-space: pre-wrap; overflow-wrap: anywhere; }
dl { display: grid; grid-template-columns: repeat(auto-fill, minmax(190px, 1fr)); gap: 10px 24px; margin: 18px 0; }
dt { color: var(--dim); font-size: 13px; } dd { margin: 0; font-variant-numeric: tabular-nums; overflow-wrap: anywhere; }
.film { display: grid; grid-template-columns: repeat(auto-fill, minmax(260px, 1fr)); gap: 12px; }
figure { margin: 0; } figcaption { color: var(--dim); font-size: 13px; } figure img { width: 100%; border-radius: 6px;
  border: 1px solid var(--line); }
.plot { overflow-x: auto; margin-bottom: 12px; } .plot svg { display: block; max-width: 100%; height: auto; min-width: 760px; }
.failed { border-left: 4px solid var(--bad); padding: 2px 0 2px 14px; margin: 0 0 14px; }
a { color: inherit; }
)css";

}  // namespace

std::string base64(std::string_view bytes) {
  constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    std::uint32_t three = 0;
    for (std::size_t i = 0; i < 3; ++i)
      three = three << 8U | (at + i < bytes.size() ? static_cast<unsigned char>(bytes[at + i]) : 0U);
    for (std::size_t i = 0; i < 4; ++i) text += at + i > bytes.size() ? '=' : letters[three >> (18 - 6 * i) & 63U];
  }
  return text;
}

std::string html_page(const std::string& title, const std::string& body, const std::string& style) {
  return "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
         "<link rel=\"icon\" href=\"data:,\">\n<title>" +
         html_text(title) + "</title>\n<style>" + page_style + style + "</style>\n</head>\n<body>\n" + body +
         "</body>\n</html>\n";
}

}  // namespace kadans
