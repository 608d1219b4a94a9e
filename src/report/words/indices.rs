//! Names of the rows of `glare::index` in other languages, by key. The English name stands in the table
//! of indices itself.

use super::Lang;
use crate::glare::index::parse;

/// Name of an index in the reader's language; the key itself where it is none of the table's.
pub fn index_name(lang: Lang, key: &str) -> &str {
    let russian = || RUSSIAN.iter().find(|(known, _)| *known == key).map(|(_, name)| *name);
    match lang {
        Lang::En => parse(key).map_or(key, |index| index.name),
        Lang::Ru => russian().unwrap_or(key),
    }
}

/// Key and name.
const RUSSIAN: &[(&str, &str)] = &[
    ("UGR", "объединённый показатель дискомфорта"),
    ("DGP", "вероятность дискомфорта от дневного света"),
    ("DGPs", "упрощённая вероятность дискомфорта от дневного света"),
    ("DGI", "показатель блёскости дневного света"),
    ("DGI_mod", "изменённый показатель блёскости дневного света"),
    ("CGI", "показатель блёскости МКО"),
    ("UGP", "объединённая вероятность дискомфорта"),
    ("UGP2", "объединённая вероятность дискомфорта, вторая форма"),
    ("UGR_exp", "опытный показатель дискомфорта"),
    ("GGR", "показатель блёскости больших помещений"),
    ("DGR", "оценка дискомфортной блёскости"),
    ("VCP", "вероятность зрительного комфорта"),
    ("M", "показатель дискомфорта"),
    ("GR", "показатель блёскости наружных площадок"),
    ("f_TI", "приращение порога"),
    ("L_veil", "вуалирующая яркость, общая формула"),
    ("L_veil_age", "вуалирующая яркость с учётом возраста"),
    ("L_veil_SH", "вуалирующая яркость по Стайлсу–Холладею"),
    ("E_v", "освещённость на зрачке"),
    ("E_dir", "часть E_v от источников"),
    ("L_b", "яркость фона"),
    ("L_mean", "средняя яркость поля зрения"),
    ("L_task", "средняя яркость рабочего поля"),
    ("L_surround", "средняя яркость окружения рабочего поля"),
    ("L_far", "средняя яркость периферии поля зрения"),
    ("L_task/L_surround", "отношение яркости рабочего поля к яркости окружения"),
    ("L_task/L_far", "отношение яркости рабочего поля к яркости периферии"),
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::glare::index::INDICES;

    #[test]
    fn every_index_has_a_russian_name_and_no_name_is_left_over() {
        // Catches an index added without its word.
        for index in INDICES {
            let name = index_name(Lang::Ru, index.key);
            assert!(name.chars().any(|c| ('а'..='я').contains(&c)), "{}: {name}", index.key);
        }
        assert_eq!(RUSSIAN.len(), INDICES.len());
    }
}
