#include <fmt/format.h>

#include "bench/write.h"
#include "io/picture/svg_plot.h"

namespace plisse::bench {
namespace {

constexpr const char* style = R"(
:root { color-scheme: light dark; --ink: #1f2328; --soft: #59636e; --paper: #fff; --card: #f6f7f9; --line: #d8dee4; --front: #0b6bcb; }
@media (prefers-color-scheme: dark) {
  :root { --ink: #e6e8eb; --soft: #9aa4af; --paper: #15181c; --card: #1d2126; --line: #343b43; --front: #6cb2ff; }
}
* { box-sizing: border-box }
body { margin: 0 auto; padding: 32px 28px 80px; max-width: 1240px; background: var(--paper); color: var(--ink);
  font: 16px/1.55 system-ui, 'Helvetica Neue', 'Liberation Sans', Arial, sans-serif }
h1 { font-size: 28px; margin: 0 0 4px } h2 { font-size: 21px; margin: 56px 0 6px; padding-top: 18px; border-top: 1px solid var(--line) }
p { max-width: 78ch; margin: 8px 0 16px } .soft { color: var(--soft) }
dl { display: grid; grid-template-columns: max-content 1fr; gap: 2px 18px; margin: 18px 0; font-size: 14px }
dt { color: var(--soft) } dd { margin: 0 }
nav a { margin-right: 16px; color: var(--front) }
.plots { display: grid; grid-template-columns: repeat(auto-fit, minmax(560px, 1fr)); gap: 18px }
.plots svg { width: 100%; height: auto; border: 1px solid var(--line); border-radius: 6px }
.pictures { display: grid; grid-template-columns: repeat(auto-fill, minmax(270px, 1fr)); gap: 14px; margin: 20px 0 }
figure { margin: 0 } figure img { width: 100%; display: block; border-radius: 6px; border: 1px solid var(--line) }
figcaption { font-size: 13px; color: var(--soft); margin-top: 4px }
.table { overflow-x: auto } table { border-collapse: collapse; font-size: 13.5px; width: 100%; margin: 14px 0 }
caption { text-align: left; font-weight: 600; padding: 10px 0 6px }
caption span { font-weight: 400; color: var(--soft) }
th, td { text-align: left; padding: 4px 12px 4px 0; border-bottom: 1px solid var(--line); vertical-align: top }
th { color: var(--soft); font-weight: 500 } td.number { font-variant-numeric: tabular-nums; white-space: nowrap }
tr.front td:first-child { font-weight: 600; color: var(--front) }
)";

std::string row_line(const Row& row) {
  return fmt::format(
      "<tr{}><td>{}{}</td><td class=\"number\">{}</td><td class=\"number soft\">{}</td><td "
      "class=\"number\">{}</td></tr>\n",
      row.on_front ? " class=\"front\"" : "", row.on_front ? "● " : "", io::xml_text(row.setting()),
      duration_text(row.seconds.median), spread_text(row.seconds), error_text(row.error));
}

// A table for every run of rows that are comparable.
std::string tables(const SuiteReport& suite) {
  std::string text;
  std::vector<bool> done(suite.rows.size(), false);
  for (std::size_t i = 0; i < suite.rows.size(); ++i) {
    if (done[i]) continue;
    const Row& first = suite.rows[i];
    text += fmt::format(
        "<div class=\"table\"><table><caption>{}: {} <span>· {}, against {} · {} for {}</span></caption>"
        "<tr><th>setting</th><th>time</th><th>quartiles</th><th>error</th></tr>\n",
        io::xml_text(first.scene), io::xml_text(first.error_of), io::xml_text(first.error_unit),
        io::xml_text(first.truth), first.clock == Clock::cpu ? "CPU time of all threads" : "wall clock",
        io::xml_text(first.seconds_of));
    for (std::size_t j = i; j < suite.rows.size(); ++j) {
      const Row& row = suite.rows[j];
      if (row.scene != first.scene || row.error_of != first.error_of || row.error_unit != first.error_unit ||
          row.seconds_of != first.seconds_of)
        continue;
      done[j] = true;
      text += row_line(row);
    }
    text += "</table></div>\n";
  }
  return text;
}

}  // namespace

std::string report_page(const BenchReport& report) {
  std::string page = fmt::format(
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">"
      "<title>plisse bench {0}</title><style>{1}</style></head><body>\n"
      "<h1>plisse bench {0}</h1>\n<p class=\"soft\">Time against error, setting by setting. A row marked ● "
      "is on the front: "
      "no other of its kind is both faster and nearer to the truth. Times are medians, with their quartiles; "
      "settings "
      "took turns.</p>\n<dl>",
      effort_text(report.effort), style);
  for (const auto& [name, value] : report.machine)
    page += fmt::format("<dt>{}</dt><dd>{}</dd>\n", io::xml_text(name), io::xml_text(value));
  page += fmt::format("<dt>took</dt><dd>{}</dd></dl>\n<nav>", duration_text(report.wall_s));
  for (const SuiteReport& suite : report.suites) page += fmt::format("<a href=\"#{0}\">{0}</a>", suite.name);
  page += "</nav>\n";
  for (const SuiteReport& suite : report.suites) {
    page += fmt::format("<h2 id=\"{}\">{}</h2>\n<p>{}</p>\n<div class=\"plots\">", suite.name,
                        io::xml_text(suite.title), io::xml_text(suite.note));
    for (const RowPlot& plot : plots(suite)) page += plot.svg;
    page += "</div>\n<div class=\"pictures\">";
    for (const Picture& picture : suite.pictures) {
      page += fmt::format(
          "<figure><a href=\"{0}\"><img src=\"{0}\" alt=\"{1}\" "
          "loading=\"lazy\"></a><figcaption>{1}</figcaption></figure>\n",
          picture.path, io::xml_text(picture.caption));
    }
    page += "</div>\n" + tables(suite);
  }
  return page + "</body></html>\n";
}

}  // namespace plisse::bench
