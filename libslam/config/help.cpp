#include <sstream>
#include <string_view>

#include <libslam/config/help.hpp>
#include <libslam/config/parameter_table.hpp>

namespace libslam {
namespace {

constexpr std::size_t kColumns = 100;

/// `text` broken at spaces into lines of at most kColumns characters.
std::string wrap(std::string_view text, std::string_view indent) {
  std::istringstream words{std::string(text)};
  std::string wrapped, line(indent);
  for (std::string word; words >> word;) {
    if (line.size() > indent.size() && line.size() + 1 + word.size() > kColumns) {
      wrapped += line + "\n";
      line = indent;
    }
    line += (line.size() > indent.size() ? " " : "") + word;
  }
  return wrapped + line + "\n";
}

std::string shown_value(const ParameterEntry& entry) {
  return entry.value.empty() ? "\"\"" : entry.value;
}

std::string escape_cell(std::string_view text) {
  std::string cell;
  for (const char c : text) {
    cell += c == '|' ? std::string("\\|") : std::string(1, c);
  }
  return cell;
}

constexpr std::string_view kIntroduction =
    R"(# Configuration

<!-- Generated: slam-run --help-config markdown > config/README.md -->

One YAML file composes a run. Every key has a default, so a file holds only what differs from it:

```yaml
motion:
  model: differential
calibration:
  scale_left:
    enabled: true
  scale_right:
    enabled: true
measurement:
  sigma_range: 0.05
```

The loader is strict. An unknown key, a key given twice, a wrong type, a value out of range or an illegal
combination ends the program with exit code 3 and one line with file, line, column, what was wrong and
the nearest valid name.

- `slam-run --help-config` prints this table.
- `slam-run config.yaml --print-config` shows the complete effective file, every default filled in, and
  runs nothing.
- `--set section.key=value` (repeatable) overrides the file.

SI units and radians; degrees only in keys that end in `_deg`.
)";

}  // namespace

std::string help_text(const ParameterTable& table) {
  std::string text;
  for (const ParameterEntry& entry : list_parameters(table)) {
    text += entry.name + " = " + shown_value(entry) + "\n";
    text += wrap(std::string("(").append(describe_domain(entry)).append(")"), "      ");
    text += wrap(entry.description.text, "      ");
  }
  return text;
}

std::string help_tables(const ParameterTable& table, int level) {
  std::string page, section;
  for (const ParameterEntry& entry : list_parameters(table)) {
    if (page.empty() || entry.section() != section) {
      section = entry.section();
      page += "\n";
      if (!section.empty())
        page.append(static_cast<std::size_t>(level), '#').append(" `").append(section) += "`\n\n";
      page += "| key | default | value | meaning |\n|---|---|---|---|\n";
    }
    page += "| `" + std::string(entry.key()) + "` | `" + shown_value(entry) + "` | " +
            escape_cell(describe_domain(entry)) + " | " + escape_cell(entry.description.text) +
            " |\n";
  }
  return page;
}

std::string help_text() {
  Parameters defaults;
  return help_text(ParameterTable(defaults));
}

std::string help_markdown() {
  Parameters defaults;
  return std::string(kIntroduction) + help_tables(ParameterTable(defaults));
}

}  // namespace libslam
