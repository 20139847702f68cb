#include "hooke/compare/page.h"

#include "hooke/compare/method_text.h"
#include "hooke/compare/page_data.h"
#include "hooke/text_of.h"

#include <cmath>

namespace hooke::app {

namespace {

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
              ? "There is nothing to measure an error against: " + escaped(reference.missing) + "."
              : "Errors are distances from " + escaped(reference.title) + ".";
  if (comparison.rigid) text += " The grey curve is " + escaped(comparison.rigid->title) + ".";
  return text + "</p>\n";
}

/// Returns a row of a list of terms.
std::string term(const char* name, const std::string& value) {
  return text_of("<dt>%s</dt><dd>", name) + value + "</dd>\n";
}

std::string limit_words(double limit) {
  if (std::isinf(limit)) return "any";
  return limit > 0 ? text_of("%.4g", limit) : "none: grows at any step";
}

/// Returns the card of one method: what it does, how it grows, where it is stable.
std::string method_card(const std::string& name, const Comparison& comparison) {
  const MethodText words = method_text(name);
  const MethodGrowth* method = comparison.stability.find(name);
  std::string text = "<div class=\"method\">\n<h3>" + escaped(name);
  if (method != nullptr) text += " (" + escaped(method->info.title) + ")";
  text += "</h3>\n<div class=\"formula\">" + escaped(words.formula) + "</div>\n<dl>\n";
  if (method != nullptr && !method->info.adaptive) {
    text += term("order", std::to_string(method->info.order));
    text += term("|g| undamped", escaped(words.growth) + " with y = h &omega;");
    text += term("stable undamped", "h &omega; &le; " + limit_words(method->info.imaginary_limit));
    text += term("stable decay", "h |&lambda;| &le; " + limit_words(method->info.real_limit));
  }
  if (method != nullptr && method->undamped) {
    text += term("this scene", text_of("h &omega; = %.4g: |g| = %.6g undamped, by its own steps",
                                       comparison.stability.system.omega * comparison.dt, *method->undamped));
    text += term("what happens",
                 text_of("at h &omega; = %.4g it ", std::abs(*method->worst)) + escaped(method->consequence));
  } else if (method != nullptr && !method->consequence.empty()) {
    text += term("what happens", "it " + escaped(method->consequence));
  }
  text += "</dl>\n<p>" + escaped(words.words) + "</p>\n";
  if (method != nullptr && !method->stable.empty())
    text += "<div class=\"region\" data-method=\"" + escaped(name) + "\"></div>\n";
  return text + "</div>\n";
}

/// Says why runs grow: the scene's fastest motion, the growth of each method, and a card for each.
std::string explanation(const Comparison& comparison) {
  std::string text =
      "<h2>Why</h2>\n<p>" + escaped(text_of_motion(comparison.stability.system, comparison.dt)) +
      " Near its start a scene is a sum of motions y' = &lambda; y, one for each eigenvalue. A "
      "step of a method multiplies each by a factor g that depends on h &lambda; alone: where |g| "
      "is more than 1, what is small now is large later, however small it is.</p>\n";
  if (!comparison.stability.methods.empty()) {
    text +=
        "<p>Measured: each method makes steps of an oscillator without damping, and g is the largest "
        "eigenvalue of what a step does.</p>\n<div id=\"growth\"></div>\n";
  }
  text +=
      "<h2>The methods</h2>\n<p class=\"about\">In the small pictures every place is one h &lambda;: to the "
      "left what fades, up and down what swings. A dot is an eigenvalue of this scene, hollow if it lies "
      "outside; a motion whose dot is off the blue grows.</p>\n<div class=\"methods\">\n";
  for (const Trial& trial : comparison.trials) text += method_card(trial.name, comparison);
  return text + "</div>\n";
}

std::string left_out(const Comparison& comparison) {
  const std::vector<std::string>& list = comparison.stability.system.left_out;
  if (list.empty()) return "";
  std::string text = "<p>The laboratory leaves out or replaces:</p>\n<ul>\n";
  for (const std::string& what : list) text += "<li>" + escaped(what) + ".</li>\n";
  return text + "</ul>\n";
}

std::string moving_part(const Comparison& comparison) {
  std::string text =
      "<h2>Side by side</h2>\n<noscript><p>The pictures of this page need JavaScript.</p></noscript>\n";
  text +=
      "<p class=\"about\">All at the same time. The colored dot is the watched point, and the line its way. "
      "A "
      "run that leaves its picture has diverged.";
  if (comparison.outline.left_out > 0)
    text += text_of(" %zu points of the object are not drawn.", comparison.outline.left_out);
  return text + "</p>\n<div id=\"motion\"></div>\n";
}

std::string plots_part(const Comparison& comparison) {
  std::string text = "<h2>Plots</h2>\n<div id=\"plot-1\"></div>\n<div id=\"plot-2\"></div>\n";
  if (comparison.schedule.stride > 1) {
    text += text_of("<p class=\"about\">One step of %zu was kept.</p>\n",
                    static_cast<std::size_t>(comparison.schedule.stride));
  }
  return text;
}

std::string numbers_part(const Comparison& comparison) {
  return "<h2>Numbers</h2>\n" + html_table(summary_table(comparison)) +
         "<p class=\"about\">In parentheses: theory. Order: slope of the error over the last halving of the "
         "step. Evaluations of the forces and measured time are per simulated second. Largest k: undamped, "
         "of "
         "1 kg on one spring at this step, by bisection; largest omega dt: the same without units. \"none\": "
         "grows at any; \"any\": never grows.</p>\n";
}

/// Returns the pictures of what the script does not draw.
std::string pictures_part(const std::vector<Picture>& pictures) {
  std::string text;
  for (const Picture& picture : pictures) {
    const bool drawn = picture.name != "order" && picture.name != "cost";
    if (drawn) continue;
    text += "<figure>\n" + embedded(picture) + "\n<figcaption>" + escaped(picture.caption) +
            "</figcaption>\n</figure>\n";
  }
  return text.empty() ? "" : "<h2>Order and cost</h2>\n" + text;
}

}  // namespace

std::string make_page(const Comparison& comparison, const std::vector<Picture>& pictures,
                      const std::string& note) {
  const std::string title = escaped(comparison.title.empty() ? comparison.scene : comparison.title);
  std::string text = "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n";
  text += "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n";
  text += "<title>" + title + ": steppers compared</title>\n<style>\n" + std::string(kPageStyle) +
          "</style>\n</head>\n";
  text += "<body>\n<h1>" + title + "</h1>\n<p class=\"about\">" + escaped(comparison.description) + "</p>\n";
  text += how(comparison) + verdicts(comparison) + left_out(comparison);
  text +=
      moving_part(comparison) + plots_part(comparison) + explanation(comparison) + numbers_part(comparison);
  if (!note.empty()) text += "<p>" + escaped(note) + "</p>\n";
  text += pictures_part(pictures);
  text += "<script type=\"application/json\" id=\"data\">" + page_data(comparison) + "</script>\n";
  return text + "<script>\n" + std::string(kPageScript) + "</script>\n</body>\n</html>\n";
}

}  // namespace hooke::app
