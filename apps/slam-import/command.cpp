#include "command.hpp"

#include <filesystem>
#include <iostream>

CLI::App* add_subcommand(CLI::App& app, CommonArguments& arguments, const std::string& name,
                         const std::string& text, const Source& source) {
  CLI::App* sub = app.add_subcommand(name, text);
  sub->add_option(source.name, arguments.directory, source.text)->required(source.required);
  sub->add_option("--out", arguments.out, "Rawlog to write; the truth goes beside it")
      ->required()
      ->check([](const std::string& file) {
        return std::filesystem::path(file).extension() == ".rawlog" ? "" : "must end in .rawlog";
      });
  sub->add_flag("--quiet", arguments.quiet, "Print errors only");
  sub->add_flag("--verbose", arguments.verbose, "Print parameters and remarks of the data set");
  return sub;
}

void print_notes(const CommonArguments& arguments, const std::map<std::string, double>& parameters,
                 const std::map<std::string, std::string>& remarks) {
  if (!arguments.verbose) return;
  for (const auto& [name, value] : parameters) std::cout << "  " << name << " = " << value << '\n';
  for (const auto& [name, text] : remarks) std::cout << "  " << name << ": " << text << '\n';
}
