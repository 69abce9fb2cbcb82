"""Files of recordings as people have them, with what is to be read of each, or why it is refused."""

import numpy as np

from tests.raceway.importing.file_writers import (
    FS,
    N,
    T,
    X,
    Y,
    array,
    changed,
    excel,
    excel_with,
    lines,
    mat,
    matlab_7_3,
    rows_of,
    text,
    wav,
    wav_24,
    workbook,
)  # fmt: skip

AT = {"rate": FS}
LVM = """LabVIEW Measurement\t
Writer_Version\t2
Reader_Version\t2
Separator\tTab
Decimal_Separator\t{point}
Multi_Headings\tNo
X_Columns\t{columns}
Time_Pref\tAbsolute
Operator\tJ. Doe
Date\t2026/11/24
Time\t10:00:00.1234567890123456789
***End_of_Header***\t
\t
Channels\t{channels}\t
Samples\t640\t
Date\t2026/11/24\t
Time\t10:00:00.1234567890123456789\t
Y_Unit_Label\t{unit}\t
X_Dimension\tTime\t
X0\t0.0000000000000000E+0\t
Delta_X\t{step}\t
***End_of_Header***\t\t
X_Value\t{names}\tComment
"""
ONE_LVM = {"point": ".", "columns": "One", "channels": 1, "unit": "g", "step": "7.8125E-5", "names": "Acceleration"}
BIG = np.round(1000 * X, 1)  # up to 900
LARGE = np.round(np.random.default_rng(5).uniform(-4000, 4000, N), 1)  # needs marks between thousands


def swiss(value: float, mark: str = "'", point: str = ".") -> str:
    return f"{value:,.1f}".replace(",", "\0").replace(".", point).replace("\0", mark)


def stamped(form: str) -> list[str]:
    return [form.format(n // 60 % 60, n % 60, n) for n in range(N)]


TITLED = "Messung 7;Halle 2\nDatum;05.01.2026 10:00\nKanäle;2\n"
ORIGIN = "Time\tAcceleration\ns\tm/s^2\n\tDE\n"
TOA5 = (
    '"TOA5","CR6","CR6","1234","CR6.Std.10","CPU:vib.CR6","5678","Fast"\n'
    '"TIMESTAMP","RECORD","ax","temp"\n"TS","RN","g","degC"\n"","","Smp","Smp"\n'
)
B_AND_K = (
    "Pulse Export\nFunction: Time(DE)\nSampling Frequency: 12.8 kHz\n"
    "X-axis unit: s\nNumber of samples: 640\nTime [s]\tAcceleration [m/s²]\n"
)
OROS = "OROS;NVGate;v12\nSampling frequency [Hz];12800\nChannel;1;Acc DE\nTime [s];Acc DE [m/s²]\n"
RIGHT = {  # file, content or writer, what is given, what is found beside X: sample rate and unit
    # spreadsheets as text
    "plain.csv": (text(T, X, mark=",", header="time [s],acc [g]\n"), {}, FS, "g"),
    "german.csv": (text(T, X, comma=True, header="Zeit [s];Beschl. [m/s²]\n"), {}, FS, "m/s2"),
    "german_two.csv": (text(X, Y, comma=True, header="x [g];y [g]\n"), {"column": 0, **AT}, FS, "g"),
    "german_titled.csv": (text(T, X, comma=True, header=TITLED + "Zeit [s];Beschl. (g)\n"), {}, FS, "g"),
    "german_latin_1.csv": (text(T * 1e6, X, header="Zeit [µs];x [m/s²]\n", encoding="latin-1"), {}, FS, "m/s2"),
    "german_slash.csv": (text(T, X, comma=True, header="t/s;a/(m/s²)\n"), {}, FS, "m/s2"),
    "german_sep.csv": (text(T, X, comma=True, header="sep=;\nZeit [s];x [mm/s²]\n"), {}, FS, "mm/s2"),
    "german_bom.csv": (text(T, X, comma=True, header="Zeit [s];x [g]\n", encoding="utf-8-sig"), {}, FS, "g"),
    "french.csv": (text(T, X, comma=True, header="Temps [s];Accélération [g]\n", encoding="latin-1"), {}, FS, "g"),
    "french_thousands.csv": (text(T, [swiss(x, "\u202f") for x in LARGE], comma=True, header="Temps [s];x [mg]\n"), {}, FS, "mg"),
    "swiss.csv": (text([swiss(x) for x in LARGE], header="x [mg]\n"), AT, FS, "mg"),
    "swiss_curly.csv": (text([swiss(x, "’") for x in LARGE], header="x [mg]\n"), AT, FS, "mg"),
    "german_thousands.csv": (text(range(N), [swiss(x, ".", ",") for x in LARGE], header="No;x [mg]\n"), AT, FS, "mg"),
    "american_thousands.csv": (text([f'"{swiss(x, ",")}"' for x in LARGE], Y, mark=",", header="x [mg],y\n"),
                               {"column": "x", **AT}, FS, "mg"),
    "half_way_thousands.csv": (text([swiss(x, ".", ",") for x in np.r_[BIG[:600], LARGE[600:]]], header="x [mg]\n"),
        {"delimiter": ";", **AT}, FS, "mg"),
    "google_german.csv": (text([f'"{t:.10f}"'.replace(".", ",") for t in T], [f'"{x}"'.replace(".", ",") for x in X], mark=",",
                               header="Zeit [s],x [g]\n"), {}, FS, "g"),
    "quoted.csv": (text(T, X, mark=",", header='"Time [s]","DE [g]"\n'), {"column": "DE [g]"}, FS, "g"),
    "quoted_comma.csv": (text(T, Y, X, mark=",", header='"Time [s]","Acc, FE [g]","Acc, DE [g]"\n'), {"column": "Acc, DE"}, FS, "g"),
    "quoted_everything.csv": (text([f'"{t:.9f}"' for t in T], [f'"{x}"' for x in X], mark=",", header='"t [s]","x [V]"\n'),
                              {"sensitivity": 9806.65}, FS, "V"),
    "line_break_in_name.csv": (text(T, X, mark=",", header='"Time\n[s]","Acc\n[g]"\n'), {}, FS, "g"),
    "separator_at_end.csv": (text(T, X, end=";", header="Time [s];x [g];\n"), {}, FS, "g"),
    "empty_lines_at_end.csv": (text(T, X, tail="\n\n;\n\n", header="t [s];x\n"), {}, FS, None),
    "note_at_end.csv": (text(T, X, comma=True, header="t [s];x [g]\n", tail="\nRMS;0,52\nEnd of data\n"), {}, FS, "g"),
    "min.csv": (text(T / 60, X, form=".15g", header="t [min];x [g]\n"), {}, FS, "g"),
    "milliseconds.csv": (text(T * 1e3, X, mark=",", header="Time (ms),Acceleration (m/s^2)\n"), {}, FS, "m/s2"),
    "mac.csv": (text(T, X, header="t [s];x [g]\n").replace("\n", "\r").encode(), {}, FS, "g"),
    "windows.csv": (text(T, X, header="t [s];x [g]\n").replace("\n", "\r\n").encode(), {}, FS, "g"),
    "utf_16.csv": (text(T, X, mark="\t", header="Zeit [s]\tx [m/s²]\n", encoding="utf-16"), {}, FS, "m/s2"),
    "named.csv": (text(T, Y, X, header="t [s];FE [g];DE [g]\n"), {"column": "DE"}, FS, "g"),
    "counter_and_times.csv": (text(np.arange(N), T, X, header="No;t [s];x [g]\n"), {}, FS, "g"),
    "counter.csv": (text(np.arange(N), X, mark=",", header="Sample,Acc (g)\n"), AT, FS, "g"),
    "whole_numbers.csv": (text(np.round(1e6 * X), np.round(1e6 * Y), mark=",", header="x,y\n"), {"column": "x", "delimiter": ",", **AT},
        FS, None),
    "three_whole.csv": (text(np.round(1e6 * X), np.round(1e6 * Y), np.round(1e6 * Y), mark=","), {"column": 0, "delimiter": ",", **AT}, FS,
        None),
    "given_comma.csv": (text(np.round(1e6 * X), np.round(1e6 * Y), mark=","), {"column": 0, "delimiter": ",", **AT}, FS, None),
    "one_german.csv": (text(X, comma=True, form=".6f"), {"delimiter": ";", **AT}, FS, None),
    "one_german_with_mark.csv": (text(X, comma=True, end=";", header="x [g];\n"), AT, FS, "g"),
    "unit_given.csv": (text(X, header="x [counts]\n"), {"unit": "g", **AT}, FS, "g"),
    "pandas.csv": (text(range(N), T, X, mark=",", header=",time [s],x [g]\n"), {}, FS, "g"),
    # rates in headers
    "sample_rate.txt": (text(X, header="Sample rate: 12800 Hz\nUnit: g\nAcceleration\n"), {}, FS, "g"),
    "sampling_rate.txt": (text(X, header="Sampling Rate = 12.8 kHz\nx [m/s2]\n"), {}, FS, "m/s2"),
    "sampling_frequency.txt": (text(X, Y, header="Sampling frequency [kHz];12,8\nA [g];B [g]\n"), {"column": "A"}, FS, "g"),
    "fs.txt": (text(X, header="# fs = 12800 Hz\n# x [g]\n"), {}, FS, "g"),
    "kilosamples.txt": (text(X, header="Sample Rate\t12.8 kS/s\nx [g]\n"), {}, FS, "g"),
    "sps.txt": (text(X, header="Sampling rate: 12800 SPS\nx [g]\n"), {}, FS, "g"),
    "megasamples.txt": (text(X, header="sample rate (MSa/s);0.0128\nx [g]\n"), {}, FS, "g"),
    "rate_apart.csv": (text(T, X, mark=",", header="Sample Rate,12800,Hz\nTime (s),x (g)\n"), {}, FS, "g"),
    "rate_without_unit.csv": (text(X, header="Sample rate: 12800\nx [g]\n"), {}, None, "g"),
    "rate_with_thousands.csv": (text(X, header="Sample rate: 12,800 Hz\nx [g]\n"), {}, None, "g"),
    "full_scale.csv": (text(X, header="Full scale (FS): 5000 Hz\nx [g]\n"), {}, None, "g"),
    "tacho_rate.csv": (text(X, header="Tacho sample rate: 1000 Hz\nx [g]\n"), {}, None, "g"),
    "german_rate.csv": (text(X, header="Abtastrate: 25600 Hz\nx [g]\n"), {}, None, "g"),
    "step.csv": (text(X, header="dt: 0.0001 s\nx [g]\n"), {}, None, "g"),
    "times_without_unit.csv": (text(T, X, header="Time;x [g]\n"), {}, None, "g"),
    "excel_days.csv": (text(46000.5 + T / 86400, X, form=".14g", header="Time;x [g]\n"), AT, FS, "g"),
    "coarse_times.csv": (text(np.round(T, 3), X, header="t [s];x [g]\n"), {}, None, "g"),
    "coarse_times_of_a_long_one.csv": (text(np.round(np.arange(6400) / FS, 4), np.tile(X, 10), header="t [s];x [g]\n"), {}, FS, "g"),
    "epoch.csv": (text([f"{1764000000 + t:.6f}" for t in T], X, header="t [s];x [g]\n"), {}, FS, "g"),
    "clock.csv": (text(stamped("10:{:02d}:{:02d}.{:06d}"), X, header="Time;x [g]\n"), AT, FS, "g"),
    "dates.csv": (text(stamped("2026-01-05 10:{:02d}:{:02d},{:03d}"), X, header="Time;x [g]\n"), AT, FS, "g"),
    "written_dates.csv": (text(['"Nov 24, 2026"'] * N, Y, X, mark=",", header='Date,FE [g],DE [g]\n'), {"column": "DE", **AT}, FS, "g"),
    "dates_between_blanks.txt": (text(["2026-01-05"] * N, stamped("10:{:02d}:{:02d}.{:06d}"), X, mark=" "), AT, FS, None),
    # programs
    "one.lvm.txt": (text(T, X, mark="\t", header=LVM.format(**ONE_LVM)), {}, FS, "g"),
    "comment.lvm.txt": (text(T, [f"{X[0]}\tstarted by hand", *X[1:]], mark="\t", header=LVM.format(**ONE_LVM)), {}, FS, "g"),
    "no_step.lvm.txt": (text(T, X, mark="\t", header=LVM.format(**ONE_LVM | {"step": "1e400"})), {}, FS, "g"),
    "samples_of_5000_digits.lvm.txt": (text(T, X, mark="\t", header=LVM.format(**ONE_LVM).replace("640", "9" * 5000)), {}, FS, "g"),
    "german.lvm.txt": (text(T, X, mark="\t", comma=True, header=LVM.format(**ONE_LVM | {"point": ",", "step": "7,8125E-5"})), {}, FS, "g"),
    "no_times.lvm.txt": (text([""] * N, X, mark="\t", header=LVM.format(**ONE_LVM | {"columns": "No"})), {}, FS, "g"),
    "two.lvm.txt": (text(T, Y, X, mark="\t",
        header=LVM.format(**ONE_LVM | {"channels": "2\t", "unit": "g\tg", "step": "7.8125E-5\t7.8125E-5",
                                                                           "names": "FE\tDE"}).replace("Time\t\n", "Time\tTime\t\n")),
                    {"column": "DE"}, FS, "g"),
    "volts.lvm.txt": (text(T, X, mark="\t", header=LVM.format(**ONE_LVM | {"unit": "Volts"})), {"unit": "V", "sensitivity": 9806.65}, FS,
        "V"),
    "origin.txt": (text(T, X, mark="\t", header=ORIGIN), {}, FS, "m/s2"),
    "origin_names.txt": (text(T, X, mark="\t", header="A(X)\tB(Y)\n"), {"unit": "g", **AT}, FS, "g"),
    "national_instruments.txt": (text(X, Y, mark="\t", header="cDAQ1Mod1/ai0\tcDAQ1Mod1/ai1\n"), {"column": "cDAQ1Mod1/ai0", **AT}, FS,
        None),
    "campbell.dat": (text(stamped('"2026-11-24 10:{:02d}:{:02d}.{:06d}"'), range(N), X, ["21.5", *[""] * (N - 1)], mark=",", header=TOA5),
                     {"column": "ax", **AT}, FS, "g"),
    "save_ascii.txt": (text(X, form="15.7e", mark=" ").replace("e", "E"), AT, FS, None),
    "save_ascii_two.txt": (lines([f"  {t:.7e}" for t in T], [f" {x: .7e}" for x in X], mark=" "), AT, FS, None),
    "save_ascii_row.txt": ("  ".join(f"{x:.7e}" for x in X) + "\n", AT, FS, None),
    "numpy.txt": (text(T, X, mark=" ", form=".18e", header="# time acc\n"), AT, FS, None),
    "fortran.dat": (text([f"{x:.6E}".replace("E", "D") for x in X]), AT, FS, None),
    "blanks.dat": (text(T, X, mark="   ", header="Time [s]  x [g]\n"), {}, FS, "g"),
    "decimal_commas_and_blanks.txt": (text(X, Y, mark=" ", comma=True), {"column": 0, **AT}, FS, None),
    "pulse.txt": (text(T, X, mark="\t", header=B_AND_K), {}, FS, "m/s2"),
    "oros.csv": (text(T, X, header=OROS), {}, FS, "m/s2"),
    "oscilloscope.csv": (text(T, X, mark=",", header="Model,MSO44\nHorizontal Units,s\nSample Interval,7.8e-05\nTIME,CH1\n"), AT, FS, None),
    "units_below.csv": (text(T, X, header="Time;DE\ns;g\n"), {"column": "DE"}, FS, "g"),
    "units_in_brackets_below.csv": (text(T, X, header="Time;DE\n[s];[mg]\n"), {}, FS, "mg"),
    "units_alone.csv": (text(T, X, header="s;g\n"), {}, FS, "g"),
    "first_row_longer.csv": (text(X, Y, [f"{Y[0]};1480", *Y[1:]]), {"column": 0, **AT}, FS, None),
    "row_longer_than_names.csv": (text(X, [Y[0], f"{Y[1]};7", *Y[2:]], header="x [g];y\n"), {"column": "x", **AT}, FS, "g"),
    "femto.csv": (text([9] * N, [39] * N, [39] * N, range(N), X, Y, mark=","), {"column": 4, **AT}, FS, None),
    "comments.txt": (text(T, X, mark=" ", header="% made by hand\n% t [s] x [g]\n", tail="% end\n"), {}, FS, "g"),
    "other_column_with_text.csv": (text(T, X, ["ok"] * N, header="t [s];x [g];state\n"), {"delimiter": ";"}, FS, "g"),
    "bar.dat": (text(Y, X, mark="|", header="FE|DE\n"), {"column": "DE", "delimiter": "|", **AT}, FS, None),
    # spreadsheets
    "sheet.xlsx": (excel(["Acceleration [g]"], X), AT, FS, "g"),
    "sheet_with_times.xlsx": (excel(["Time [ms]", "x [m/s²]"], T * 1e3, X, before=[["Pump 7"], []]), {}, FS, "m/s2"),
    "chosen_sheet.xlsx": (workbook({"a": [["x"], [0.5]], "Data": rows_of(["x [g]"], X)}), {"variable": "Data", **AT}, FS, "g"),
    "active_sheet.xlsx": (workbook({"a": rows_of(["x [g]"], Y), "b": rows_of(["x [g]"], X)}, active=1), AT, FS, "g"),
    "hidden_first.xlsx": (workbook({"old": rows_of(["x [g]"], Y), "new": rows_of(["x [g]"], X)}, hidden=["old"]), AT, FS, "g"),
    "hidden_active.xlsx": (workbook({"new": rows_of(["x [g]"], X), "old": rows_of(["x"], Y)}, hidden=["old"], active=1), AT, FS, "g"),
    "hidden_named.xlsx": (workbook({"new": rows_of(["x"], Y), "old": rows_of(["x [g]"], X)}, hidden=["old"]), {"variable": "old", **AT},
        FS, "g"),
    "rate_in_a_cell.xlsx": (excel(["x [g]"], X, before=[["Sample rate [Hz]", FS]]), {}, FS, "g"),
    # arrays
    "float.wav": (wav(X, dtype="f8"), {}, FS, None),
    "stereo.wav": (wav(Y, X, dtype="f8"), {"column": 1, "unit": "g"}, FS, "g"),
    "bits_24.wav": (wav_24, {}, FS, None),
    "many.mat": (mat(DE_time=X, FE_time=Y, rpm=1797.0), {"variable": "DE*", **AT}, FS, None),
    "level_4.mat": (mat("4", x=X), AT, FS, None),
    "level_7_3.mat": (matlab_7_3, {"variable": "vibration", **AT}, FS, None),
    "with_times.mat": (mat(data=np.stack([T, X], axis=1)), AT, FS, None),
    "two_rows.npy": (array(np.stack([Y, X])), {"column": 1, **AT}, FS, None),
    "two_columns.npy": (array(np.stack([Y, X], axis=1)), {"column": 1, **AT}, FS, None),
    "times_and_signal.npy": (array(np.stack([T, X])), {}, None, None),
}  # fmt: skip
OTHER_VALUES = {
    **dict.fromkeys(["french_thousands.csv", "swiss.csv", "swiss_curly.csv", "german_thousands.csv", "american_thousands.csv"], LARGE),
    "half_way_thousands.csv": np.r_[BIG[:600], LARGE[600:]],
    **dict.fromkeys(["whole_numbers.csv", "three_whole.csv", "given_comma.csv"], np.round(1e6 * X)),
    "coarse_times_of_a_long_one.csv": np.tile(X, 10),
}  # fmt: skip
PLAIN = text(T, X, mark=",", header="time [s],acc [g]\n")
ONE = text(X, header="acc [g]\n")
THREE = text(T, X, Y, mark=",", header="Time [s],DE [g],FE [g]\n")
WHOLE = [f"{round(value * 1e4):,}".replace(",", ".") for value in X]
LOST = "lines would be lost; correct the file, or cut it there."
DELIMITER, COLUMN, UNIT, RATE, VARIABLE = (
    f"with {option}." for option in ("--delimiter", "--channel", "--unit", "--rate", "--channel")
)
REFUSED = {  # file, content or writer, what is given, part of the sentence
    # columns
    "none_chosen.csv": (THREE, {}, "has 3 columns (0 Time [s], 1 DE [g], 2 FE [g]) and none is chosen; choose one with --channel."),
    "no_such_name.csv": (THREE, {"column": "x"},
                         "has the columns 0 Time [s], 1 DE [g], 2 FE [g], and no numbers in x; choose one with --channel."),
    "no_such_number.csv": (THREE, {"column": 7}, "and no numbers in 7; choose one with --channel."),
    "times_chosen.csv": (THREE, {"column": 0},
        "has times or a counter in column 0 Time [s], and no signal; choose another with --channel."),
    "counter_alone.csv": (text(range(N)), AT, "has times or a counter in column 0, and no signal"),
    "times_alone.csv": (text(T, ["a"] * N, header="t [s];x [g]\n"), {"delimiter": ";"}, "has times or a counter in column 0 t [s]"),
    "column_of_text.csv": (text(T, ["a"] * N, X, header="t [s];x;y\n"), {"delimiter": ";", "column": "x"}, "and no numbers in x"),
    "two_of_one_name.csv": (text(T, X, Y, header="t [s];x [g];x [V]\n"), {"column": "x"}, "has several columns x (1 x [g], 2 x [V])"),
    "comma_in_a_name.csv": (text(T, X, Y, mark=",", header="t [s],Acc, FE [g],Acc, DE [g]\n"), {"column": "DE [g]"},
        "and no numbers in DE"),
    "unit_of_lost_names.csv": (text(T, X, mark=",", header="t [s],Acc, DE [g]\n"), {"column": 1, **AT}, UNIT),
    "r_write_table.txt": (text([f'"{n}"' for n in range(N)], X, Y, mark=" ", header='"x" "y"\n'), {"column": "x"}, "and no numbers in x"),
    "uneven.csv": (text(np.where(T > 0.02, T + 0.01, T), X, header="t [s];x\n"), {}, "that are not evenly spaced; export it at one"),
    "dropped_sample.csv": (text(np.delete(T, 300), X[1:], header="t [s];x\n"), {}, "that are not evenly spaced; export it at one"),
    "dropped_millisecond.csv": (text(np.delete(np.arange(N + 1), 300) / 1000, X, header="t [s];x\n"), {},
        "that are not evenly spaced; export it"),
    "dropped_count.csv": (text(np.delete(np.arange(N + 1), 300), X, header="n;x\n"), AT,
        "has times in column 0 n that are not evenly spaced"),
    "restart.csv": (text(np.r_[T[:320], T[:320]], X, header="t [s];x\n"), {}, "that are not evenly spaced; export it at one"),
    "restart_without_unit.csv": (text(np.r_[T[:320], T[:320]], X, header="time;x [g]\n"), AT, "that are not evenly spaced"),
    "spectrum.csv": (text(np.arange(N) * 0.5, X, header="Frequency;Level [g]\n"), {}, "has frequencies in column 0 Frequency; export the"),
    "spectrum_in_hertz.csv": (text(np.arange(N) * 0.5, X, header="f [Hz];a [g]\n"), AT, "has frequencies in column 0 f [Hz]"),
    # rows
    "thousands_half_way.csv": (text(T, [f"{x:.1f}" if n < 600 else swiss(x) for n, x in enumerate(LARGE)], header="t [s];x [mg]\n"), {},
                               "has no row like the others in line 602"),
    "comma_half_way.csv": (text(T, [f"{x}".replace(".", "," if n > 600 else ".") for n, x in enumerate(X)], header="t [s];x\n"), {},
                           "has no row like the others in line 603"),
    "more_fields_half_way.csv": (PLAIN + lines(T, X, mark=",", comma=True), {}, "has no row like the others in line 642"),
    "whole_with_points.csv": (text(WHOLE, Y, header="x;y [g]\n"), {"column": 0, **AT}, "can be read in two ways"),
    "scaled.csv": ("x\n" + "-1.234\n567\n" * 300, AT, "that can be read in two ways, such as 1.234; give the decimal mark with --decimal."),
    "overload.csv": (changed(PLAIN, 500, "0.03,OVL"), {}, f"has no row like the others in line 500 ('0.03 OVL'), where 142 {LOST}"),
    "overload_first_field.csv": (changed(ONE, 500, "OVL"), AT, f"has no row like the others in line 500 ('OVL'), where 142 {LOST}"),
    "overload_at_end.csv": (ONE + "OVL\n" * 3, AT, f"has no row like the others in line 642 ('OVL'), where 3 {LOST}"),
    "not_available.csv": (changed(PLAIN, 300, "0.02,#N/A"), {}, "has no row like the others in line 300"),
    "not_available_at_end.csv": (ONE + "#N/A\n", AT, "has no row like the others in line 642"),
    "nan.csv": (changed(PLAIN, 42, "0.003,nan"), {}, f"has no row like the others in line 42 ('0.003 nan'), where 600 {LOST}"),
    "nan_in_one.csv": (changed(ONE, 42, "NaN"), AT, f"has no row like the others in line 42 ('NaN'), where 600 {LOST}"),
    "infinite.csv": (changed(PLAIN, 42, "0.003,-Inf"), {}, "has no row like the others in line 42"),
    "text_number.csv": (changed(PLAIN, 400, "0.03,'0.5"), {}, "has no row like the others in line 400"),
    "formula.csv": (changed(PLAIN, 400, '0.03,"=""0.5"""'), {}, "has no row like the others in line 400"),
    "percent.csv": (changed(PLAIN, 400, "0.03,50%"), {}, "has no row like the others in line 400"),
    "gap.csv": (changed(PLAIN, 600, "0.0467,"), {}, "has no row like the others in line 600"),
    "gap_in_times.csv": (changed(PLAIN, 600, ",0.5"), {}, "has no row like the others in line 600"),
    "short_column.csv": (text(T, X, header="t [s];x\n", tail="0.06;\n0.07;\n"), {}, "has no row like the others in line 642"),
    "short_row.csv": (changed(PLAIN, 600, "0.0467"), {}, "has no row like the others in line 600"),
    "empty_line.csv": (changed(PLAIN, 600, ""), {}, f"has no row like the others in line 600 (''), where 42 {LOST}"),
    "text_inside.csv": (changed(PLAIN, 400, "started again"), {},
        f"has no row like the others in line 400 ('started again'), where 242 {LOST}"),
    "second_part.csv": (PLAIN + PLAIN, {}, f"has no row like the others in line 642 ('time [s] acc [g]'), where 641 {LOST}"),
    "late_text.csv": (text(X.tolist() * 20) + "stop\n0.5\n", AT, f"has no row like the others in line 12801 ('stop'), where 2 {LOST}"),
    "many_notes.csv": (PLAIN + "note\n" * 21, {}, "has more than 20 lines of text from line 642 on"),
    "note_with_number.csv": (PLAIN + "640 samples,\n", {}, "in line 642"),
    "pandas_series.csv": (text(range(N), X, mark=",", header=",0\n"), {"column": 1, **AT}, "has no row like the others in line 1 (' 0')"),
    "gap_between_blanks.txt": (changed(text(X, Y, T, mark=" "), 300, "0.5 0.7"), {"column": 1, **AT},
        "has no row like the others in line 300"),
    "overload_first.csv": ("OVL\n" + lines(X), AT, "in line 1 ('OVL'), where 641 lines would be lost; correct that line."),
    "marked_first.csv": (text(T, X, header="t [s];x [g]\n0*;0.5\n"), {}, "has no row like the others in line 2"),
    "marked_last.csv": (PLAIN + "0.06*,0.5\n", {}, "has no row like the others in line 642"),
    "number_in_header.csv": ("Sample rate [Hz]\n12800\nAcceleration [g]\n" + lines(X), {}, "has no row like the others in line 3"),
    "tektronix.csv": (text(["Record Length", "Sample Interval", *[""] * (N - 2)], ["640", "7.8125e-05", *[""] * (N - 2)], [""] * N, T, X,
        mark=","),
                      {"column": 4}, "has no row like the others in line 2"),
    "no_numbers.csv": ("a;b\n" * 300, {}, DELIMITER),
    "commas.csv": (text(T, X, mark=",", comma=True, form=".6f", header="t,x\n"), {"column": 1}, DELIMITER),
    "one_with_commas.csv": (text(X, comma=True, form=".6f", header="x [g]\n"), AT, DELIMITER),
    "one_with_commas_in_name.csv": (text(X, comma=True, form=".6f", header="Acc, DE [g]\n"), {"column": 0, **AT}, DELIMITER),
    "whole_after_dates.csv": ("05.01.2026,512,37\n" * 99, {"column": 1}, DELIMITER),
    "whole_or_decimal.csv": ("512,37\n-10,200\n13,45\n" * 100, {"column": 1}, DELIMITER),
    "blank_thousands.csv": ("512 371\n-10 200\n13 453\n" * 100, {"column": 1}, DELIMITER),
    "zeros.csv": (PLAIN.encode() + bytes(5000), {}, "is no text with columns: it holds zero bytes"),
    "binary.dat": (bytes(range(256)) * 40, {}, "is no text with columns: it holds zero bytes"),
    "open_quote.csv": ('"x [g]\n' + lines(X), AT, "has no row of numbers"),
    # rates
    "other_rate.csv": (THREE, {"column": 1, "rate": 25600.0},
                       "is at 12800 Hz by its times in column 0 Time [s], and 25600 Hz are given; correct what is given with --rate."),
    "other_rate.txt": (text(X, header="fs = 12800 Hz\n"), {"rate": 12000.0},
                       "is at 12800 Hz by its header, and 12000 Hz are given; correct what is given with --rate."),
    "two_rates.csv": (text(T, X, header="Sample rate: 25,6 kHz\nt [s];x\n"), {},
                      "is at 25600 Hz by its header and 12800 Hz by its times in column 0 t [s]; give the sample rate with --rate."),
    "two_rates_in_header.csv": (text(X, header="Sample rate: 25.6 kHz\nfs = 12800 Hz\n"), {}, RATE),
    "slow.csv": (text(np.arange(N) / 100, X, header="t [s];x\n"), {},
        "is at 100 Hz by its times in column 0 t [s], beyond 500 Hz to 1 MHz; give"),
    "fast.csv": (text(X, header="fs = 12.8 MHz\n"), {},
        "is at 1.28e+07 Hz by its header, beyond 500 Hz to 1 MHz; give the sample rate with --rate."),
    "slow.wav": (wav(X, fs=100), {}, RATE),
    # units
    "other_unit.csv": (THREE, {"column": 1, "unit": "m/s2"},
                       "states column 1 DE [g] in its header, and the unit m/s2 is given; correct what is given with --unit."),
    "volts.csv": (text(T, X, header="t [s];x [mV]\n"), {}, "the unit is mV and the sensitivity of the sensor is missing"),
    **{f"quantity_{n}.csv": (text(T, X, header=f"t [s];{name}\n"), unit,
        f"states column 1 {name} in its header, which is no acceleration and cannot be used; correct") for n, (name, unit) in enumerate(
            (name, unit) for unit in ({}, {"unit": "g"}) for name in
            ("v [mm/s]", "x (dB)", "x [in/s]", "x/in/s", "s (µm)", "Velocity", "x [m/s]", "p [kPa]"))},
    **{f"unit_{n}.csv": (text(T, X, header=f"t [s];{name}\n"), {}, UNIT) for n, name in enumerate(
        ["x [counts]", "x [A]", "x [Gal]", "x [G]", "x [g rms]", "x []", "accel_g", "Beschl. m/s²",
         "raw counts", "x (filtered)", "Acc V", "S/mV/g", "Spannung [Volt]"])},
    "unit_row.csv": (text(T, X, header="t;x\ns;counts\n"), {}, UNIT),
    "unit_line.csv": (text(T, X, header="Einheit: g\nt [s];x\n"), {}, UNIT),
    "sensitivity.txt": (text(X, header="Sensitivity: 100 mV/g\nx\n"), AT, UNIT),
    "two_unit_lines.txt": (text(X, header="Unit: g\nUnit: V\nx\n"), AT, UNIT),
    "volts.lvm.txt": (text(T, X, mark="\t", header=LVM.format(**ONE_LVM | {"unit": "Volts"})), {}, UNIT),
    "rigol.csv": (text(range(N), X, mark=",", header="X,CH1,Start,Increment\nSequence,Volt,-0.025,7.8125e-05\n"), AT, UNIT),
    # spreadsheets
    "text_number.xlsx": (excel_with("0.5"), {}, "has no row like the others in line 300"),
    "boolean.xlsx": (excel_with(True), {}, "has no row like the others in line 300"),
    "error.xlsx": (excel_with("#DIV/0!"), {}, "has no row like the others in line 300"),
    "formula.xlsx": (excel_with(None), {}, "has no row like the others in line 300"),
    "word.xlsx": (excel_with("OVL", 2), {}, "has no row like the others in line 2"),
    "all_formulas.xlsx": (workbook({"Data": [["t [s]", "x [g]"], *([float(t), None] for t in T)]}), {"column": "x"}, "and no numbers in x"),
    "text_numbers.xlsx": (workbook({"Data": [["t [s]", "x [g]"], *([str(t), float(x)] for t, x in zip(T, X, strict=True))]}),
        {"column": 0}, COLUMN),
    "no_such_sheet.xlsx": (excel(["x"], X), {"variable": "Run"}, "holds the sheets Data, Notes, not Run; name one with --channel."),
    "hidden_alone.xlsx": (workbook({"a": rows_of(["x"], X)}, hidden=["a"]), {},
        "holds the sheets a, none of which is visible; name one with"),
    "empty_sheet.xlsx": (excel(["x"], X), {"variable": "Notes"}, "has no row of numbers among its first 0 lines"),
    "no_excel.xlsx": ("x", {}, "is truncated, damaged or not a spreadsheet file"),
    "far_corner.xlsx": (workbook({"a": '<row r="1"><c r="XFD1048576"><v>1</v></c></row>'}), {},
        "has a sheet of 16384 columns and 1048576 rows"),
    "far_cell.xlsx": (workbook({"a": "<row r='9'><c s='1' r='CV1048576'><v>1</v></c></row>"}), {}, "and the limit is 2000000000"),
    # arrays
    "stereo.wav": (wav(X, Y), {}, "has 2 columns (0, 1) and none is chosen; choose one with --channel."),
    "many.mat": (mat(DE=X, FE=Y, rpm=1797.0), {}, "more than one variable with 100 numbers or more; name one with --channel."),
    "times_and_signal.mat": (mat(t=T, x=X), {}, VARIABLE),
    "complex.mat": (mat(x=X * 1j), {"variable": "x"}, "neither real numbers nor text in it"),
    "times.npy": (array(T), AT, "has times or a counter in column 0, and no signal"),
    "two_rows.npy": (array(np.stack([X, Y])), {}, "has 2 columns (0, 1) and none is chosen; choose one with --channel."),
    "windows.npy": (array(np.zeros((300, 256))), {"column": 0}, "not one column of real numbers, or a few long ones"),
    "nan.npy": (array(np.where(np.arange(N) == 40, np.nan, X)), AT,
        "has 1 samples of 640 that are not finite numbers, the first is number 41"),
    "structured.npy": (array(np.zeros(N, dtype=[("t", float), ("x", float)])), AT, "not one column of real numbers, or a few long ones"),
    "complex.npy": (array(X * 1j), AT, "not one column of real numbers, or a few long ones"),
    "beyond_numbers.npy": (array(X * 1e308), {"unit": "g", **AT}, "has values beyond the range of numbers; check its unit."),
    "number.npy": (array(np.array(0.5)), AT, "not one column of real numbers, or a few long ones"),
}  # fmt: skip
