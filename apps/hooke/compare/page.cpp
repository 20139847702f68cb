#include "hooke/compare/page.h"

#include "hooke/text_of.h"

#include <string_view>

namespace hooke::app {

namespace {

constexpr std::string_view kStyle = R"(
body { font: 16px/1.5 system-ui, "DejaVu Sans", sans-serif; color: #222; background: #fff;
       max-width: 1100px; margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.6rem; margin-bottom: 0; }
h2 { font-size: 1.2rem; margin-top: 2.2rem; }
p.about { color: #555; margin-top: .3rem; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; font-size: .85rem; font-variant-numeric: tabular-nums; }
th, td { padding: .3rem .6rem; text-align: right; border-bottom: 1px solid #ddd; white-space: nowrap; }
th { white-space: normal; vertical-align: bottom; border-bottom: 2px solid #888; }
th:first-child, td:first-child { text-align: left; }
figure { margin: 1.5rem 0; }
figure svg { max-width: 100%; height: auto; }
figcaption { color: #555; font-size: .9rem; }
)";

std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

void replace_all(std::string& text, std::string_view what, const std::string& by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size())) {
    text.replace(at, what.size(), by);
  }
}

/// Returns the svg element alone. Its names are made unique, because several pictures share the page.
std::string embedded(const Picture& picture) {
  const std::size_t start = picture.svg.find("<svg");
  std::string svg = start == std::string::npos ? "" : picture.svg.substr(start);
  for (const char quote : {'\'', '"'}) {
    replace_all(svg, std::string(" id=") + quote, std::string(" id =") + quote + picture.name + "_");
    replace_all(svg, std::string("href=") + quote + "#",
                std::string("href =") + quote + "#" + picture.name + "_");
  }
  replace_all(svg, "url(#", "url( #" + picture.name + "_");
  return svg;
}

std::string html_table(const Table& table) {
  std::string text = "<div class=\"wide\"><table>\n";
  for (const auto& row : table) {
    const char* tag = &row == &table.front() ? "th" : "td";
    text += "<tr>";
    for (const std::string& cell : row) text += text_of("<%s>", tag) + escaped(cell) + text_of("</%s>", tag);
    text += "</tr>\n";
  }
  return text + "</table></div>\n";
}

std::string verdicts(const Comparison& comparison) {
  std::string text = "<ul>\n";
  for (const Trial& trial : comparison.trials) {
    text += "<li><b>" + escaped(trial.name) + "</b> " + escaped(verdict_of(trial, comparison)) + ".</li>\n";
  }
  for (const Skipped& one : comparison.skipped) {
    text += "<li><b>" + escaped(one.name) + "</b> was skipped: " + escaped(one.reason) + ".</li>\n";
  }
  return text + "</ul>\n";
}

std::string how(const Comparison& comparison) {
  const Reference& reference = comparison.reference;
  std::string text = text_of("<p>%.4g s in steps of %.4g s, watched at ", comparison.seconds, comparison.dt) +
                     "<code>" + escaped(comparison.point) + "</code>. ";
  text += reference.samples.empty()
              ? "The laboratory refuses this scene, so there is nothing to measure an error "
                "against."
              : "Errors are distances from " + escaped(reference.title) + ".";
  if (comparison.rigid) text += " The grey curve is " + escaped(comparison.rigid->title) + ".";
  return text + "</p>\n";
}

}  // namespace

std::string make_page(const Comparison& comparison, const std::vector<Picture>& pictures,
                      const std::string& note) {
  const std::string title = escaped(comparison.title.empty() ? comparison.scene : comparison.title);
  std::string text = "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n";
  text += "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n";
  text += "<title>" + title + ": steppers compared</title>\n<style>" + std::string(kStyle) +
          "</style>\n</head>\n";
  text += "<body>\n<h1>" + title + "</h1>\n<p class=\"about\">" + escaped(comparison.description) + "</p>\n";
  text += how(comparison) + verdicts(comparison);
  text += "<h2>Numbers</h2>\n" + html_table(summary_table(comparison));
  text +=
      "<p class=\"about\">In parentheses: theory. Order: slope of the error over the last halving of the "
      "step. "
      "Evaluations of the forces and measured time are per simulated second. Largest k: undamped, of 1 kg on "
      "one "
      "spring at this step, by bisection; largest omega dt: the same without units. \"none\": grows at any; "
      "\"any\": never grows.</p>\n";
  if (!note.empty()) text += "<p>" + escaped(note) + "</p>\n";
  if (!pictures.empty()) text += "<h2>Pictures</h2>\n";
  for (const Picture& picture : pictures) {
    text += "<figure>\n" + embedded(picture) + "\n<figcaption>" + escaped(picture.caption) +
            "</figcaption>\n</figure>\n";
  }
  return text + "</body>\n</html>\n";
}

}  // namespace hooke::app
