//! Tables in the ways of spreadsheets, MATLAB and Python, and tables refused.

use std::f64::consts::TAU;

use super::*;

const COLUMNS: [Column; 4] = [
    Column::optional("scene", Content::Title),
    Column::required("frequency_hz", Content::Number(Quantity::Frequency)).or_called(&["omega"]),
    Column::optional("mode_type", Content::Choice(&["rotational", "planet"])),
    Column::optional("multiplicity", Content::Count(1, 9)),
];

fn read(text: &str) -> Table {
    Table::parse("modes.csv".as_ref(), text, &COLUMNS).unwrap()
}

fn refusal(text: &str) -> String {
    Table::parse("modes.csv".as_ref(), text, &COLUMNS).unwrap_err().to_string()
}

fn remarks(table: &Table) -> Vec<String> {
    table.remarks.iter().map(Remark::to_string).collect()
}

fn hertz(table: &Table) -> Vec<f64> {
    table.rows.iter().filter_map(|row| table.number(row, "frequency_hz")).collect()
}

#[test]
fn as_excel_writes_with_a_mark_semicolons_and_decimal_commas() {
    let table = read(
        "\u{feff}sep=;\r\nMode_Type;Frequency [kHz];Scene;Damping;Note\r\n\
         Planet;0,7705;\"a set, four planets\";1\r\n;;;\r\nrotational;1,5;a set, again;2\r\n",
    );
    assert_eq!(hertz(&table), [770.5, 1500.0]);
    let [first, second] = table.rows.as_slice() else { panic!("two rows") };
    assert_eq!((first.line, second.line), (3, 5));
    assert_eq!(table.text(first, "scene"), Some("a set, four planets"));
    assert_eq!(table.text(second, "scene"), Some("a set, again"));
    assert_eq!(table.text(first, "mode_type"), Some("planet"));
    assert_eq!(
        remarks(&table),
        [
            "modes.csv:2: column `Frequency [kHz]`: read as `frequency_hz`, numbers times 1000",
            "modes.csv:2: columns `Damping`, `Note`: kept aside, asked for by no check",
            "modes.csv:3: column `Frequency [kHz]`: decimal commas read",
        ]
    );
}

#[test]
fn as_matlab_and_pandas_write_with_comments_an_index_and_titles_without_quotes() {
    let table = read(
        "# my model\n\n,omega_rad_per_s,scene,multiplicity\n0,100,\"a, b\",1\n\n# more\n1,1e3,a set, four planets,2.0\n",
    );
    assert_eq!(hertz(&table), [100.0 * (1.0 / TAU), 1e3 * (1.0 / TAU)]);
    assert_eq!(table.rows.iter().map(|row| row.line).collect::<Vec<_>>(), [4, 7]);
    assert_eq!(table.text(&table.rows[1], "scene"), Some("a set, four planets"));
    assert_eq!(table.count(&table.rows[1], "multiplicity"), Some(2));
    assert_eq!(
        remarks(&table),
        [
            "modes.csv:3: column `omega_rad_per_s`: read as `frequency_hz`, numbers times 0.1591549",
            "modes.csv:7: column `scene`: titles with commas and without quotes put together",
        ]
    );
}

#[test]
fn tabs_single_columns_and_an_absent_last_line_end() {
    assert_eq!(hertz(&read("frequency_hz\n770,5\n800.25")), [770.5, 800.25]);
    assert_eq!(hertz(&read("mode_type\tfrequency_hz\n\t7,5\nplanet\t8\n")), [7.5, 8.0]);
}

#[test]
fn units_of_every_quantity_by_the_title() {
    let columns = [
        Column::required("position_m", Content::Number(Quantity::Length)),
        Column::required("phase_rad", Content::Number(Quantity::Angle)),
        Column::required("speed_rpm", Content::Number(Quantity::Speed)),
        Column::required("sun_torque_nm", Content::Number(Quantity::Torque)),
        Column::required("position", Content::Number(Quantity::CyclePart)),
        Column::required("amplitude", Content::Number(Quantity::ByRow)),
    ];
    let text = "position_mm,phase_deg,speed_rad_per_s,sun_torque_knm,position_percent,Amplitude (µm)\n2,180,6.283185307179586,1.5,25,3\n";
    let table = Table::parse("t.csv".as_ref(), text, &columns).unwrap();
    let row = &table.rows[0];
    let number = |column| table.number(row, column).unwrap();
    assert_eq!(number("position_m"), 0.002);
    assert!((number("phase_rad") - TAU / 2.0).abs() < 1e-15);
    assert!((number("speed_rpm") - 60.0).abs() < 1e-12);
    assert_eq!((number("sun_torque_nm"), number("position")), (1500.0, 0.25));
    assert_eq!(
        (number("amplitude"), table.dimension("amplitude")),
        (3.0 * 1e-6, Some(Dimension::Length))
    );
    assert_eq!(table.remarks.len(), 6);
}

#[test]
fn refusals_name_file_line_column_and_remedy() {
    for (text, message) in [
        (
            "",
            "modes.csv: no rows: a line of titles (`frequency_hz`) and at least one row are needed, or leave the file out",
        ),
        (
            "frequency_hz\n",
            "modes.csv: no rows: a line of titles (`frequency_hz`) and at least one row are needed, or leave the file out",
        ),
        (
            "# a\nfrequenzy_hz;scene\n1;a\n",
            "modes.csv:2: column `frequency_hz` is absent: `frequenzy_hz` is not known; did you mean `frequency_hz`? \
             allowed are frequency_hz, frequency_khz, frequency_rad_per_s, frequency_rad_s, frequency_rpm, omega_hz, \
             omega_khz, omega_rad_per_s, omega_rad_s, omega_rpm",
        ),
        (
            "770.5,planet\n800,planet\n",
            "modes.csv:1: column `frequency_hz` is absent: the first line must be titles, such as `frequency_hz`",
        ),
        (
            "frequency_hz,frequency_khz\n1,1\n",
            "modes.csv:1: columns `frequency_hz` and `frequency_khz` are both `frequency_hz`: keep one",
        ),
        (
            "frequency_hz,multiplicity\n1,1\n770,5,1\n",
            "modes.csv:3: 3 cells under 2 titles, the last is column `multiplicity`: put texts with separators into \
             quotes; with decimal commas separate columns by `;`",
        ),
        (
            "frequency_hz\n1\nfast\n",
            "modes.csv:3: column `frequency_hz` is `fast`: allowed is a finite number",
        ),
        (
            "frequency_hz\nNaN\n",
            "modes.csv:2: column `frequency_hz` is `NaN`: allowed is a finite number",
        ),
        (
            "frequency_hz,scene\n\"770,5\",a\n",
            "modes.csv:2: column `frequency_hz` is `770,5`: allowed is a finite number, with one decimal comma only \
             where columns are separated by `;` or tabs",
        ),
        (
            "Frequency_Hz;mode_type\n1;planet\n\n2;sideways\n",
            "modes.csv:4: column `mode_type` is `sideways`: allowed is rotational, planet",
        ),
        (
            "frequency_hz;multiplicity\n1;18446744073709551615\n",
            "modes.csv:2: column `multiplicity` is `18446744073709551615`: allowed is a whole number from 1 to 9",
        ),
        (
            "scene;frequency_hz\na;\n",
            "modes.csv:2: column `frequency_hz` is empty: needed is a finite number",
        ),
    ] {
        assert_eq!(refusal(text), message);
    }
}
