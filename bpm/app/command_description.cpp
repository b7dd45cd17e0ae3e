// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/app/command_description.h"

#include <fmt/format.h>
#include <stdexcept>
#include <vector>

namespace boba {

namespace {

/// Long names of a command's options, as --output.
std::vector<const CLI::Option*> named_options(const CLI::App& app) {
  std::vector<const CLI::Option*> result;
  for (const CLI::Option* option : app.get_options()) {
    if (!option->get_lnames().empty()) {
      result.push_back(option);
    }
  }
  return result;
}

std::string long_name(const CLI::Option& option) {
  return "--" + option.get_lnames().front();
}

bool takes_value(const CLI::Option& option) {
  return option.get_items_expected_max() > 0;
}

/// Backslashes and hyphens as troff wants them; a dot or quote at the start of a line would be a command.
std::string troff(const std::string& text) {
  std::string result;
  for (const char c : text) {
    const bool starts_line = result.empty() || result.back() == '\n';
    result += starts_line && (c == '.' || c == '\'') ? "\\&" : "";
    result += c == '\\' ? std::string("\\e") : c == '-' ? std::string("\\-") : std::string(1, c);
  }
  return result;
}

std::string shown_name(const CLI::Option& option) {
  std::string text;
  for (const std::string& name : option.get_snames()) {
    text += "-" + name + ", ";
  }
  text += option.get_lnames().empty() ? option.get_name() : long_name(option);
  if (takes_value(option) && !option.get_lnames().empty()) {
    text += " " + option.get_type_name();
  }
  return text;
}

std::string manual_options(const CLI::App& app) {
  std::string text;
  for (const CLI::Option* option : app.get_options()) {
    const std::string fallback =
        option->get_default_str().empty() ? "" : fmt::format(" (default {})", option->get_default_str());
    text += fmt::format(".TP\n.B {}\n{}\n", troff(shown_name(*option)), troff(option->get_description() + fallback));
  }
  return text;
}

/// The text in single quotes of a POSIX shell.
std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) {
    result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  }
  return result + "'";
}

std::string joined(const std::vector<std::string>& words) {
  std::string result;
  for (const std::string& word : words) {
    result += (result.empty() ? "" : " ") + word;
  }
  return result;
}

std::vector<std::string> command_names(const CLI::App& program) {
  std::vector<std::string> names;
  for (const CLI::App* sub : program.get_subcommands({})) {
    names.push_back(sub->get_name());
  }
  return names;
}

std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : named_options(app)) {
    names.push_back(long_name(*option));
  }
  return names;
}

std::string bash_completion(const CLI::App& program) {
  std::string cases;
  for (const CLI::App* sub : program.get_subcommands({})) {
    cases += fmt::format("    {}) words=\"{}\" ;;\n", sub->get_name(), joined(option_names(*sub)));
  }
  return fmt::format("# bash completion of boba, written by `boba info --completion bash`\n"
                     "_boba() {{\n"
                     "  local current=${{COMP_WORDS[COMP_CWORD]}} words=\"\"\n"
                     "  if [ \"$COMP_CWORD\" -eq 1 ]; then\n"
                     "    COMPREPLY=($(compgen -W \"{} {}\" -- \"$current\"))\n"
                     "    return\n"
                     "  fi\n"
                     "  case ${{COMP_WORDS[1]}} in\n{}  esac\n"
                     "  if [[ $current == -* ]]; then\n"
                     "    COMPREPLY=($(compgen -W \"$words\" -- \"$current\"))\n"
                     "  else\n"
                     "    COMPREPLY=($(compgen -f -- \"$current\"))\n"
                     "  fi\n"
                     "}}\n"
                     "complete -o filenames -F _boba boba\n",
                     joined(command_names(program)), joined(option_names(program)), cases);
}

/// Brackets and colons have a meaning in zsh's descriptions.
std::string zsh_text(const std::string& text) {
  std::string result;
  for (const char c : text) {
    result += std::string(c == '[' || c == ']' || c == ':' ? "\\" : "") + c;
  }
  return result;
}

std::string zsh_completion(const CLI::App& program) {
  std::string commands, cases;
  for (const CLI::App* sub : program.get_subcommands({})) {
    commands += "    " + quoted(sub->get_name() + ":" + zsh_text(sub->get_description())) + "\n";
    cases += fmt::format("    {}) _arguments", sub->get_name());
    for (const CLI::Option* option : named_options(*sub)) {
      cases += " \\\n      " + quoted(fmt::format("{}[{}]{}", long_name(*option), zsh_text(option->get_description()),
                                                  takes_value(*option) ? ":value:_files" : ""));
    }
    cases += " \\\n      '*:file:_files' ;;\n";
  }
  return fmt::format("#compdef boba\n# zsh completion of boba, written by `boba info --completion zsh`\n"
                     "_boba() {{\n  local -a commands\n  commands=(\n{}  )\n"
                     "  if (( CURRENT == 2 )); then\n    _describe command commands\n    return\n  fi\n"
                     "  local chosen=$words[2]\n  shift words\n  (( CURRENT-- ))\n"
                     "  case $chosen in\n{}  esac\n}}\n_boba \"$@\"\n",
                     commands, cases);
}

std::string fish_completion(const CLI::App& program) {
  std::string text = "# fish completion of boba, written by `boba info --completion fish`\n";
  for (const CLI::App* sub : program.get_subcommands({})) {
    text += fmt::format("complete -c boba -n __fish_use_subcommand -f -a {} -d {}\n", sub->get_name(),
                        quoted(sub->get_description()));
    for (const CLI::Option* option : named_options(*sub)) {
      text += fmt::format("complete -c boba -n '__fish_seen_subcommand_from {}' -l {}{} -d {}\n", sub->get_name(),
                          option->get_lnames().front(), takes_value(*option) ? " -r" : "",
                          quoted(option->get_description()));
    }
  }
  return text;
}

} // namespace

std::string manual_page(const CLI::App& program, const std::string& version) {
  std::string text = fmt::format(".TH BOBA 1 \"\" \"boba {}\" \"Boba\"\n.SH NAME\nboba \\- packings of deformable "
                                 "grains\n.SH SYNOPSIS\n.B boba\n.I COMMAND\n[arguments]\n.SH DESCRIPTION\n{}\n"
                                 ".SH OPTIONS\n{}.SH COMMANDS\n",
                                 version, troff(program.get_description()), manual_options(program));
  for (const CLI::App* sub : program.get_subcommands({})) {
    text += fmt::format(".SS {}\n{}.\n{}", troff("boba " + sub->get_name()), troff(sub->get_description()),
                        manual_options(*sub));
    if (!sub->get_footer().empty() && sub->get_footer() != program.get_footer()) {
      text += fmt::format(".PP\n{}\n", troff(sub->get_footer()));
    }
  }
  return text + fmt::format(".SH EXIT STATUS\n{}\n", troff(program.get_footer()));
}

std::string shell_completion(const CLI::App& program, const std::string& shell) {
  if (shell == "bash") {
    return bash_completion(program);
  }
  if (shell == "zsh") {
    return zsh_completion(program);
  }
  if (shell == "fish") {
    return fish_completion(program);
  }
  throw std::invalid_argument(fmt::format("--completion {}: there are bash, zsh, fish", shell));
}

} // namespace boba
