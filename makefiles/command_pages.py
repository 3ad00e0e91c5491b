#!/usr/bin/env python3
"""Writes the manual page floe.1 and the bash completion from what `floe --help` says, so that they cannot grow old."""
import os
import re
import subprocess
import sys


def help_of(floe, *words):
    done = subprocess.run([floe, *words, "--help"], capture_output=True, text=True, check=True)
    return done.stdout


def section(text, title):
    """The entries [name, description] under a title of CLI11's help."""
    found, inside = [], False
    for line in text.splitlines():
        if line.startswith(title + ":"):
            inside = True
        elif inside and not line.strip():
            break
        elif inside and re.match(r"^  \S", line):
            parts = re.split(r"\s{2,}", line.strip(), maxsplit=1)
            found.append([parts[0], parts[1] if len(parts) > 1 else ""])
        elif inside and found:
            found[-1][1] = (found[-1][1] + " " + line.strip()).strip()
    return found


def roff(text):
    return text.replace("\\", "\\e").replace("-", "\\-").replace("'", "\\(aq")


def manual(version, about, commands, petsc):
    lines = [f'.TH FLOE 1 "" "floe {version}" "User Commands"', ".SH NAME", f"floe \\- {roff(about)}", ".SH SYNOPSIS",
             ".B floe", "[OPTIONS] COMMAND ...", ".br", ".B mpirun \\-n", "N", ".B floe", "COMMAND ...", ".SH COMMANDS"]
    for name, description, text in commands:
        usage = re.search(r"^Usage: (.*)$", text, re.M).group(1)
        lines += [".SS " + roff(name), roff(description) + ".", ".PP", ".B " + roff(usage)]
        for option, meaning in section(text, "Positionals") + section(text, "Options"):
            lines += [".TP", ".B " + roff(option), roff(meaning)]
    lines += [".SH PETSC OPTIONS", roff(petsc), ".SH EXIT STATUS", "0: done. 1: the run failed. 2: the input is bad.",
              ".SH SEE ALSO", "The grammar of scenes:", ".B floe schema"]
    return "\n".join(lines) + "\n"


def completion(commands):
    cases = []
    for name, _, text in commands:
        options = sorted({word for option, _ in section(text, "Options")
                          for word in re.findall(r"(?<![\w-])--?[a-z][\w-]*", option.split(" ")[0])})
        cases.append(f"    {name}) words='{' '.join(options)}' ;;")
    names = " ".join(name for name, _, _ in commands)
    return f"""# bash completion for floe; written by makefiles/command_pages.py
_floe() {{
  local now=${{COMP_WORDS[COMP_CWORD]}} words= command= word
  for word in "${{COMP_WORDS[@]:1:COMP_CWORD-1}}"; do
    [[ " {names} " == *" $word "* ]] && {{ command=$word; break; }}
  done
  case "$command" in
    '') words='{names} --help --version' ;;
{chr(10).join(cases)}
  esac
  if [[ $now == -* || -z $command ]]; then
    COMPREPLY=($(compgen -W "$words" -- "$now"))
  else
    COMPREPLY=($(compgen -f -X '!*.@(yaml|yml|h5|xdmf)' -- "$now") $(compgen -d -- "$now"))
  fi
}}
complete -o filenames -F _floe floe
"""


def main():
    floe, out = sys.argv[1:]
    whole = help_of(floe)
    version, about = re.match(r"floe (\S+): (.*)", whole).groups()
    commands = [(name, description, help_of(floe, name)) for name, description in section(whole, "Subcommands")]
    petsc = whole.strip().splitlines()[-1]
    os.makedirs(out, exist_ok=True)
    with open(os.path.join(out, "floe.1"), "w", encoding="utf-8") as file:
        file.write(manual(version, about, commands, petsc))
    with open(os.path.join(out, "floe.bash"), "w", encoding="utf-8") as file:
        file.write(completion(commands))


if __name__ == "__main__":
    main()
