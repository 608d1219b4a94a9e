//! Words of `gershun lamp` in Russian, by their English. The sentences of findings are in
//! [`super::findings`].

use super::Lang;

/// English, Russian.
const TERMS: &[(&str, &str)] = &[
    ("luminaire", "светильник"),
    ("format", "формат"),
    ("its 0° plane, along the length, is C90 here", "его плоскость 0° вдоль длины — здесь C90"),
    ("flux", "световой поток"),
    ("lm by exact integration", "лм точным интегрированием"),
    ("lm by the zonal rule", "лм по зональному правилу"),
    ("lm rated", "лм заявлено"),
    ("none rated", "не заявлен"),
    ("output ratio", "КПД"),
    (" stated", " (заявлен)"),
    ("LOR not stated", "не указан"),
    ("LOR", "полный"),
    ("DLOR", "вниз"),
    ("ULOR", "вверх"),
    ("of the flux down", "потока вниз"),
    ("power", "мощность"),
    ("not stated", "не указана"),
    ("W", "Вт"),
    ("lm/W", "лм/Вт"),
    ("at", "при"),
    ("cd", "кд"),
    ("cd/klm", "кд/клм"),
    ("opening", "выходное отв."),
    ("symmetry", "симметрия"),
    ("about the vertical axis", "относительно вертикальной оси"),
    ("about both planes", "относительно обеих плоскостей"),
    ("about C90–C270", "относительно C90–C270"),
    ("about C0–C180", "относительно C0–C180"),
    ("none", "нет"),
    ("beam (50 %)", "угол (50 %)"),
    ("field (10 %)", "угол (10 %)"),
    ("CIE flux code", "код потока CIE"),
    ("spacing S/h", "шаг S/h"),
    ("diagonal", "по диагонали"),
    ("intensity", "класс силы"),
    ("glare index", "блёскость D"),
    ("BUG rating", "класс BUG"),
    ("limits unverified", "пределы не проверены"),
    ("limits from one public source", "пределы по одному открытому источнику"),
    ("none of G*1 … G*6", "ни один из G*1 … G*6"),
    ("by", "по"),
    ("all quadrants alike", "все квадранты одинаковы"),
    ("street towards", "улица в сторону"),
    ("zonal flux, lm", "поток по зонам, лм"),
    ("luminance, cd/m²", "яркость, кд/м²"),
    ("all C", "все C"),
    ("findings", "замечания"),
    ("line", "строка"),
    ("lm", "лм"),
    ("none: a point", "нет: точечный источник"),
    ("rectangle", "прямоугольник"),
    ("(length × width)", "(длина × ширина)"),
    ("(length × width × height)", "(длина × ширина × высота)"),
    ("(level × upright)", "(по горизонтали × по вертикали)"),
    ("(width × height)", "(ширина × высота)"),
    (", luminous sides", ", светящие боковины"),
    ("(ends)", "(торцы)"),
    ("(long sides)", "(длинные стороны)"),
    ("disc", "круг"),
    (", luminous height", ", светящая высота"),
    ("ellipse", "эллипс"),
    ("sphere", "шар"),
    ("ellipsoid", "эллипсоид"),
    ("lying cylinder", "лежачий цилиндр"),
    ("along C0–C180", "вдоль C0–C180"),
    ("along C90–C270", "вдоль C90–C270"),
    ("upright", "вертикальный"),
    ("facing", "обращён к"),
    ("m", "м"),
    ("note", "замечание"),
    ("warning", "предупреждение"),
    ("error", "ошибка"),
    ("`gershun explain CODE` says more about a code", "`gershun explain --lang ru КОД` объясняет код"),
    ("files", "файлов"),
    ("errors", "ошибок"),
    ("warnings", "предупреждений"),
    ("notes", "замечаний"),
    // UGR tables.
    ("UGR by CIE 117 and CIE 190, for the file's", "UGR по CIE 117 и CIE 190 для потока файла"),
    ("spacing to height", "отношение шага к высоте"),
    ("ceiling", "потолок"),
    ("walls", "стены"),
    ("floor", "пол"),
    ("crosswise", "поперёк"),
    ("endwise", "вдоль"),
    // Far field.
    ("emitted", "излучено"),
    ("leaves", "выходит"),
    ("table", "таблица"),
    ("interpolated", "с интерполяцией"),
    ("exactness", "точность"),
    ("standard error", "стандартная погрешность"),
    ("of the largest intensity, rms", "наибольшей силы света, среднеквадратично"),
    ("directions", "направлений"),
    ("blocks", "блоков"),
    ("blurred", "размыто"),
    (
        "leave by a mirror: their directions are blurred by one step of the table",
        "выходит через зеркало: направления размыты на один шаг таблицы",
    ),
    // Polar diagrams.
    ("C0–C180, across the length", "C0–C180, поперёк длины"),
    ("C90–C270, along the length", "C90–C270, вдоль длины"),
    ("no beam angle", "угла пучка нет"),
    ("for the luminaire's", "на поток светильника"),
    ("outer ring", "внешнее кольцо"),
    ("Luminous intensity", "Сила света"),
    // Conversion.
    ("dropped", "не перенесено"),
    ("light output ratio", "КПД светильника"),
    ("LM-63 has no place for it", "в LM-63 для него нет места"),
    ("rated flux", "заявленный поток"),
    ("the new file states", "новый файл заявляет"),
    ("colour rendering", "цветопередача"),
    ("luminous opening", "выходное отверстие"),
    ("the new file holds", "в новом файле"),
    ("so its luminance differs", "поэтому яркость отличается"),
    ("name", "название"),
    ("written as", "записано"),
    ("not carried over if present", "не переносится, если есть"),
    (
        "size of the luminaire, numbers, date, lamp names, colour, further lamp sets, tilt, direct ratios",
        "габариты светильника, номера, дата, названия ламп, цветность, другие комплекты ламп, наклон, коэффициенты использования",
    ),
    (
        "size of the luminaire, numbers, date, lamp names, colour, further lamp sets, tilt; direct ratios become 0",
        "габариты светильника, номера, дата, названия ламп, цветность, другие комплекты ламп, наклон; коэффициенты использования становятся 0",
    ),
    (
        "spectra, colour other than R_a, equipment, custom data, comments",
        "спектры, показатели цвета кроме R_a, сведения об оборудовании, свои данные изготовителя, примечания",
    ),
    (
        "keywords other than the names, tilt data, lamp count; all factors become 1",
        "ключевые слова кроме названий, данные о наклоне, количество ламп; все множители становятся 1",
    ),
];

/// An English term in a language.
pub fn lamp_word(lang: Lang, english: &'static str) -> &'static str {
    match lang {
        Lang::En => english,
        Lang::Ru => {
            TERMS.iter().find(|(known, _)| *known == english).map_or(english, |(_, russian)| *russian)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches: a term that was left in English, or that nobody says any more.
    #[test]
    fn every_term_is_said_and_none_is_missing() {
        let sources = [
            include_str!("../lamp/convert.rs"),
            include_str!("../lamp/far_field.rs"),
            include_str!("../lamp/lint.rs"),
            include_str!("../lamp/opening.rs"),
            include_str!("../lamp/polar.rs"),
            include_str!("../lamp/text.rs"),
            include_str!("../lamp/ugr.rs"),
        ];
        for source in sources {
            for call in source.split("say(\"").skip(1) {
                let english = call.split('"').next().unwrap_or_default();
                assert!(TERMS.iter().any(|(known, _)| *known == english), "{english} has no translation");
            }
        }
        for (english, russian) in TERMS {
            let said = format!("\"{english}\"");
            assert!(sources.iter().any(|source| source.contains(&said)), "nobody says {english}");
            assert!(!russian.is_empty());
        }
    }
}
