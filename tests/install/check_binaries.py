# SPDX-License-Identifier: BSD-3-Clause
"""What stands in the binaries: protections of the program, symbols of shared libraries. Needs binutils.

    check_binaries.py hardened PROGRAM [COMPILER]    with a compiler also a control without any, which must be refused
    check_binaries.py exported PREFIX                of the shared libraries below PREFIX, against the headers there
"""
import pathlib
import re
import subprocess
import sys
import tempfile


def output(*command):
    return subprocess.run([str(c) for c in command], stdout=subprocess.PIPE, check=True, text=True).stdout


def unprotected(program):
    """What is missing."""
    elf = output("readelf", "-W", "-h", "-l", "-d", program)
    imported = output("nm", "-D", "--undefined-only", program)
    stack = re.search(r"GNU_STACK(?:\s+0x\w+){5}\s+([RWE ]+?)\s+0x", elf)
    found = {
        "a position of its own (PIE)": re.search(r"Type:\s+DYN", elf),
        "relocations made read-only": "GNU_RELRO" in elf,
        "all symbols bound at the start": re.search(r"BIND_NOW|FLAGS_1.*NOW", elf),
        "a stack that is no code": stack and "E" not in stack.group(1),
        "guards on stacks": "__stack_chk_fail" in imported,
    }
    return [what for what, is_there in found.items() if not is_there]


def hardened(program, compiler=None):
    faults = unprotected(program)
    if compiler:
        with tempfile.TemporaryDirectory() as folder:
            source, control = pathlib.Path(folder, "control.cpp"), pathlib.Path(folder, "control")
            source.write_text("int main() {}\n")
            subprocess.run([compiler, "-O0", "-fno-stack-protector", "-U_FORTIFY_SOURCE", "-no-pie", "-fno-pie",
                            "-Wl,-z,norelro,-z,lazy,-z,execstack", source, "-o", control], check=True)
            refused = unprotected(control)
            if len(refused) != 5:
                faults.append(f"the control should lack all five, but lacks only {refused}")
    return faults


def exported(prefix):
    headers = " ".join(p.read_text() for p in pathlib.Path(prefix, "include").rglob("*.h"))
    declared = set(re.findall(r"\w+", headers))
    libraries = sorted(p for p in pathlib.Path(prefix).rglob("liblivens_*.so*") if not p.is_symlink())
    faults = [] if len(libraries) == 2 else [f"expected the libraries core and io, found {libraries}"]
    for library in libraries:
        soname = re.search(r"SONAME.*\[(.*)\]", output("readelf", "-W", "-d", library)).group(1)
        if not re.fullmatch(r"liblivens_\w+\.so\.\d+\.\d+", soname):
            faults.append(f"{library.name}: its name for the loader, {soname}, has no version")
        symbols = output("nm", "-D", "--defined-only", "--demangle", library).splitlines()
        names = [line.split(None, 2)[2] for line in symbols]
        if not any(name.startswith("livens::") for name in names):
            faults.append(f"{library.name}: exports nothing of livens")
        for name in names:
            of_livens = re.match(r"(?:(?:typeinfo(?: name)?|vtable|VTT|guard variable) for )?livens::(.*)", name)
            # What a function or class is called must be declared in a header; return types of templates come first.
            words = re.match(r"[\w:~]+", of_livens.group(1)).group(0).split("::") if of_livens else []
            if not words or not all(word.lstrip("~") in declared for word in words):
                faults.append(f"{library.name}: exports {name}")
    return faults


if __name__ == "__main__":
    if subprocess.run(["sh", "-c", "command -v readelf nm"],
                                                        stdout=subprocess.DEVNULL).returncode != 0:
        print("SKIPPED: binutils are not installed")
        sys.exit(77)
    found = {"hardened": hardened, "exported": exported}[sys.argv[1]](*sys.argv[2:])
    print("\n".join(found) or f"{sys.argv[1]}: good")
    sys.exit(1 if found else 0)
