"""Which Debian packages a list of them brings, and which package a file is of: as dpkg knows it."""
import os
import re
import subprocess


def lines_of(*command):
    return subprocess.run(command, capture_output=True, text=True, check=False).stdout.splitlines()


FIELDS = "${Package}\t${Pre-Depends}, ${Depends}\t${Provides}\t${Essential}\t${Priority}\t${db:Status-Status}\t${Architecture}\n"


def installed_packages():
    here = ("installed\tall", "installed\t" + "".join(lines_of("dpkg", "--print-architecture")))
    return [line for line in lines_of("dpkg-query", "-W", "-f", FIELDS) if line.endswith(here)]


# What each needs, of the packages that `lines` (of FIELDS) describe.
class Packages:
    def __init__(self, lines):
        self.depends = {}
        self.provided_by = {}
        self.always = set()
        for line in lines:
            name, depends, provides, essential, priority = line.split("\t")[:5]
            self.depends[name] = depends
            for provided in filter(None, provides.split(",")):
                self.provided_by.setdefault(provided.split()[0], []).append(name)
            if essential == "yes" or priority == "required":
                self.always.add(name)

    # apt takes the first of several alternatives that can be had, and so do we: others may be here by chance.
    def chosen(self, alternatives):
        for alternative in alternatives.split("|"):
            name = re.split(r"[\s(:]", alternative.strip())[0]
            if name in self.depends:
                return [name]
            if name in self.provided_by:
                return self.provided_by[name]
        return []

    def closure(self, listed):
        known = set()
        waiting = [package for name in listed for package in self.chosen(name)] + list(self.always)
        while waiting:
            package = waiting.pop()
            if package not in known:
                known.add(package)
                for alternatives in self.depends[package].split(","):
                    waiting += self.chosen(alternatives)
        return known


# /lib is /usr/lib on merged systems, and dpkg knows files by either name.
def merged(path):
    return re.sub(r"^/usr(?=/(bin|sbin|lib\w*)/)", "", path)


# Names by which a package may know a file: links on the way to it are followed one kind at a time, as a link itself
# (libz.so) belongs to another package than what it leads to, and those of /etc/alternatives to none.
def names_of(path):
    path = os.path.normpath(path)
    folder, name = os.path.split(path)
    return list(dict.fromkeys(merged(p) for p in (path, os.path.join(os.path.realpath(folder), name), os.path.realpath(path))))


class Declared:
    def __init__(self, packages, listed):
        self.packages = packages.closure(listed)
        native = "".join(lines_of("dpkg", "--print-architecture"))
        names = [name + end for name in sorted(self.packages) for end in ("", ":" + native)]
        self.files = {merged(line) for line in lines_of("dpkg-query", "-L", *names)}

    def has(self, path):
        return any(name in self.files for name in names_of(path))


# The package of a file, or None.
def owner(path):
    for name in names_of(path) if path.startswith("/") else ():
        for candidate in (name, "/usr" + name):
            found = lines_of("dpkg-query", "-S", candidate)
            if found:
                return found[0].rsplit(": ", 1)[0]
    return None
