#!/usr/bin/env python3
"""Examples of odeint and of SUNDIALS, their programs and ours: lines of code and time.

    bench/examples/compare.py BUILD --odeint DIRECTORY --sundials DIRECTORY

BUILD contains the libraries of Continuo. Ours are the programs on docs/coming_from_odeint.md and
docs/coming_from_sundials.md, theirs are the files in libs/numeric/odeint/examples of Boost and in examples/ of SUNDIALS
(of the distribution: /usr/share/doc/libsundials-dev/examples). Both are compiled with -O2. A whole program is timed, without its output: printf of both does nothing, and streams
are in a failed state. `main` of each is called again and again in one process, the two in turn, and the least processor
time of a call counts. Lines are those with code: no blank lines, no comments.
"""

import argparse
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]

# Page, number of the program on the page, and the example that it stands for. The loop of the chaotic system does not
# end: its limit is that of our program.
PAIRS = [
    ("coming_from_odeint", 1, "harmonic_oscillator.cpp", []),
    ("coming_from_odeint", 2, "stuart_landau.cpp", []),
    ("coming_from_odeint", 3, "chaotic_system.cpp", [("while( true )", "while( count < 1000 )")]),
    ("coming_from_odeint", 4, "fpu.cpp", []),
    ("coming_from_odeint", 5, "solar_system.cpp", []),
    ("coming_from_odeint", 6, "multiprecision/lorenz_mp.cpp", []),
    ("coming_from_sundials", 1, "cvode/serial/cvRoberts_dns.c + ida/serial/idaRoberts_dns.c", []),
    ("coming_from_sundials", 2, "cvodes/serial/cvsRoberts_FSA_dns.c", []),
    ("coming_from_sundials", 3, "cvode/serial/cvAdvDiff_bnd.c", []),
    ("coming_from_sundials", 4, "cvode/serial/cvDiurnal_kry.c", []),
    ("coming_from_sundials", 5, "ida/serial/idaHeat2D_bnd.c", []),
    ("coming_from_sundials", 6, "arkode/C_serial/ark_brusselator_fp.c", []),
    ("coming_from_sundials", 7, "arkode/C_serial/ark_kepler.c", []),  # of SUNDIALS 7
    ("coming_from_sundials", 8, "cvode/serial/cvRocket_dns.c", []),
    ("coming_from_sundials", 9, "ida/serial/idaSlCrank_dns.c", []),
    ("coming_from_sundials", 10, "cvode/serial/cvRoberts_dns_constraints.c", []),
    ("coming_from_sundials", 11, "cvode/serial/cvRoberts_block_klu.c", []),
    ("coming_from_sundials", 12, "cvode/serial/cvPendulum_dns.c", []),
    ("sensitivities_cpp", 3, "cvodes/serial/cvsRoberts_ASAi_dns.c", []),
]
ARGUMENTS = {"cvsRoberts_FSA_dns.c": ["-sensi", "sim", "t"]}

DRIVER = r"""
#include <cstdio>
#include <ctime>
#include <iostream>
extern "C" {
int example_main(int, char**);
int no_printf(const char*, ...) { return 0; }
int no_fprintf(FILE*, const char*, ...) { return 0; }
int no_puts(const char*) { return 0; }
int no_putchar(int) { return 0; }
}
int main(int count, char** arguments) {
  std::cout.setstate(std::ios::failbit), std::clog.setstate(std::ios::failbit);
  double least = 1e9, total = 0;
  for (int runs = 0; runs < 5 || (runs < 2000 && total < 0.3); ++runs) {
    timespec begin{}, end{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &begin);
    example_main(count, arguments);
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &end);
    const double seconds = double(end.tv_sec - begin.tv_sec) + 1e-9 * double(end.tv_nsec - begin.tv_nsec);
    total += seconds;
    if (seconds < least) least = seconds;
  }
  std::fprintf(stderr, "%.9f\n", least);
}
"""


def program_on(page, number):
    text = (ROOT / "docs" / f"{page}.md").read_text()
    return re.findall(r"^```cpp\n(.*?)^```", text, re.S | re.M)[number - 1]


def lines_of_code(source):
    source = re.sub(r"/\*.*?\*/", "", source, flags=re.S)
    source = re.sub(r"//.*", "", source)
    return sum(1 for line in source.splitlines() if line.strip())


def call(command, **options):
    done = subprocess.run(command, shell=True, capture_output=True, text=True, **options)
    if done.returncode != 0:
        raise RuntimeError(done.stdout[-500:] + done.stderr[-2000:])
    return done.stdout


def build(scratch, name, source, flags, libraries):
    """The program with its main renamed, behind a main that times it."""
    folder = pathlib.Path(scratch)
    suffix = ".c" if source.suffix == ".c" else ".cpp"
    (folder / "driver.cpp").write_text(DRIVER)
    compiler = "gcc" if suffix == ".c" else "g++ -std=c++20"
    call(f"{compiler} -O2 -w {flags} -I{source.parent} -c {source} -o {folder}/{name}.o")
    renamed = ["main=example_main"] + [f"{one}=no_{one}" for one in ("printf", "fprintf", "puts", "putchar")]
    call("objcopy " + " ".join(f"--redefine-sym {one}" for one in renamed) + f" {folder}/{name}.o")
    call(f"g++ -O2 {folder}/driver.cpp {folder}/{name}.o -o {folder}/{name} {libraries}")
    return folder / name


def sundials_libraries(example):
    solver = {"cvode": "cvode", "cvodes": "cvodes", "ida": "ida", "arkode": "arkode"}[example.split("/")[0]]
    others = ("nvecserial sunmatrixdense sunmatrixband sunlinsoldense sunlinsolband sunlinsolspgmr sunlinsolspgmr "
              "sunnonlinsolfixedpoint sunmatrixsparse sunlinsolklu")
    return f"-lsundials_{solver} " + " ".join(f"-lsundials_{one}" for one in others.split()) + " -lm"


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("build", type=pathlib.Path)
    options.add_argument("--odeint", type=pathlib.Path)
    options.add_argument("--sundials", type=pathlib.Path)
    options.add_argument("--only", type=str, default="", help="examples whose name contains this")
    chosen = options.parse_args()
    libraries = sorted(chosen.build.glob("libcontinuo_*.a"))
    ours_linked = ("-Wl,--start-group " + " ".join(map(str, libraries)) + " -Wl,--end-group -lfmt -lklu -ludunits2 "
                   "-lnetcdf -lceres -lglog -lgflags -lspqr -ltbb -lcholmod -lcxsparse -llapack -lblas -lpthread")
    print("| Example | Lines, ours | theirs | Time, ours | theirs | Ratio |\n|---|---|---|---|---|---|")
    for page, number, example, changes in PAIRS:
        root = chosen.odeint if page.endswith("odeint") else chosen.sundials
        if root is None or chosen.only not in example:
            continue
        theirs_files = example.split(" + ")
        label = " + ".join(f"`{pathlib.Path(one).name}`" for one in theirs_files)
        if not all((root / one).exists() for one in theirs_files):
            print(f"| {label} | {lines_of_code(program_on(page, number))} | not there | | | |")
            continue
        texts = [(root / one).read_text() for one in theirs_files]
        for old, new in changes:
            texts = [text.replace(old, new) for text in texts]
        with tempfile.TemporaryDirectory() as scratch:
            source = pathlib.Path(scratch) / "ours.cpp"
            source.write_text(program_on(page, number))
            try:
                ours = build(scratch, "ours", source,
                             f"-DFMT_SHARED -I{ROOT} -I/usr/include/eigen3 -fno-math-errno -fno-trapping-math",
                             ours_linked)
                theirs = []
                for k, (one, text) in enumerate(zip(theirs_files, texts)):
                    their_source = pathlib.Path(scratch) / (f"theirs{k}" + pathlib.Path(one).suffix)
                    their_source.write_text(text)
                    theirs.append(build(scratch, f"theirs{k}", their_source,
                                        f"-I{(root / one).parent} -I/usr/include/suitesparse",
                                        "" if page.endswith("odeint") else sundials_libraries(one)))
            except RuntimeError as error:
                print(f"{label}: {error}", file=sys.stderr)
                continue
            arguments = " ".join(ARGUMENTS.get(pathlib.Path(example).name, []))
            times = {program: [] for program in [ours, *theirs]}
            for _ in range(3):
                for program in times:
                    times[program].append(float(call(f"{program} {arguments} 2>&1 >/dev/null", cwd=scratch).split()[-1]))
            mine, other = min(times[ours]), sum(min(times[program]) for program in theirs)
            print(f"| {label} | {lines_of_code(source.read_text())} | {sum(map(lines_of_code, texts))} | "
                  f"{mine * 1e3:.3f} ms | {other * 1e3:.3f} ms | {mine / other:.2f} |", flush=True)


if __name__ == "__main__":
    main()
