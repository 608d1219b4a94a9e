//! What is found in photometric files, and what follows from it, in other languages: patterns as in
//! [`super::sentences`]. A part in «…» is text of the file and stays as it is.

use std::borrow::Cow;

use super::Lang;
use super::faults::FAULTS;
use super::sentences::{SENTENCES, look_up};

/// A message or consequence of a finding in the reader's language; English where no pattern matches.
pub fn found(lang: Lang, text: &str) -> Cow<'_, str> {
    match lang {
        Lang::En => Cow::Borrowed(text),
        Lang::Ru => look_up(&[FINDINGS, FAULTS, SENTENCES], text).map_or(Cow::Borrowed(text), Cow::Owned),
    }
}

/// A message or a consequence in Russian, if it is one.
pub(super) fn finding(text: &str) -> Option<String> {
    look_up(&[FINDINGS], text)
}

/// Patterns in English and Russian.
const FINDINGS: &[(&str, &str)] = &[
    // Flux and power.
    ("rated {} lm, integrates to {} lm", "заявлено {} лм, интеграл силы света даёт {} лм"),
    (
        "Ē is {} % {} than the rated flux suggests; set `flux` to choose",
        "Ē на {} % {}, чем следует из заявленного потока; выбрать поток можно ключом `flux`",
    ),
    ("higher", "выше"),
    ("lower", "ниже"),
    ("{} lm from {} W are {} lm/W", "{} лм при {} Вт – это {} лм/Вт"),
    (
        "no luminaire reaches that: the flux is too high by a factor of {} or more, or the power belongs to a part of it; illuminance, or the energy balance, is wrong by as much",
        "таких светильников не бывает: поток завышен в {} раза или больше либо указана мощность лишь части светильника; во столько же ошибочны освещённость или расчёт мощности",
    ),
    (
        "no luminaire is that poor: the flux is too low (per 1000 lm?) or the power too high; illuminance, or the energy balance, is wrong by as much",
        "таких слабых светильников не бывает: занижен поток (на 1000 лм?) или завышена мощность; во столько же ошибочны освещённость или расчёт мощности",
    ),
    ("no power is stated", "мощность не указана"),
    (
        "efficacy and installed power per area cannot be computed",
        "световую отдачу и удельную установленную мощность рассчитать нельзя",
    ),
    ("a light output ratio of {} %", "КПД светильника {} %"),
    (
        "a luminaire gives no more than its lamps: the rated flux is {} % too high, or the lamps' too low",
        "светильник не может дать больше света, чем его лампы: заявленный поток завышен на {} % либо занижен поток ламп",
    ),
    ("{} lamps of {} lm", "ламп: {}, поток каждой {} лм"),
    (
        "read as absolute photometry (−1 lm): the candelas stand as they are",
        "прочитано как абсолютная фотометрия (−1 лм): канделы взяты без пересчёта",
    ),
    (
        "{} lamp sets, of which the first is used ('{}', {} lm, {} W)",
        "комплектов ламп: {}; взят первый («{}», {} лм, {} Вт)",
    ),
    (
        "another set changes every illuminance by {} % to {} %; set `flux` for it",
        "с другим комплектом все освещённости изменятся на {} … {} %; поток задаётся ключом `flux`",
    ),
    (
        "another set gives another flux; set `flux` for it",
        "у другого комплекта другой поток; он задаётся ключом `flux`",
    ),
    (
        "{} % of the flux goes down as stated, {} % by the intensities",
        "вниз по заявлению идёт {} % потока, по силам света – {} %",
    ),
    (
        "the intensities are used: direct illuminance is {} % against the statement; check that the luminaire is not upside down",
        "в расчёт идут силы света: прямая освещённость отличается от заявленного на {} %; проверьте, не перевёрнут ли светильник",
    ),
    ("conversion factor '{}'", "коэффициент пересчёта «{}»"),
    (
        "taken as 1: every illuminance is wrong by the factor that was meant",
        "принят равным 1: все освещённости ошибочны на тот коэффициент, который имелся в виду",
    ),
    (
        "the field after the ballast factor is {}, expected 1",
        "поле после коэффициента ПРА равно {}, должно быть 1",
    ),
    (
        "not applied; where it is meant as a factor, every illuminance is {} times as high",
        "не применяется; если это всё же множитель, все освещённости изменятся в {} раза",
    ),
    // The opening.
    ("no luminous area", "светящая площадь не задана"),
    (
        "the luminaire counts as a point: its luminance, UGR and glare are undefined; set `area`",
        "светильник считается точкой: его яркость, UGR и блёскость не определены; задайте `area`",
    ),
    ("'{}' is no size in mm", "«{}» – не размер в мм"),
    (
        "taken as 0, which makes the luminous area smaller and its luminance higher",
        "принят равным 0: светящая площадь становится меньше, а яркость выше",
    ),
    (
        "the luminous area of {} × {} m lies beyond the luminaire of {} × {} m (length × width)",
        "светящая площадь {} × {} м выходит за габариты светильника {} × {} м (длина × ширина)",
    ),
    (
        "it fits when turned by 90°: C0 and C90 are swapped in the dimensions or in the intensities, so luminance and UGR belong to the other direction of view",
        "она помещается, если повернуть её на 90°: C0 и C90 перепутаны в размерах или в силах света, и яркость с UGR относятся к другому направлению взгляда",
    ),
    (
        "if the luminaire's size is right, the luminance is up to {} times as high as computed",
        "если габариты светильника верны, яркость выше расчётной, до {} раза",
    ),
    (
        "near the horizon the opening of {} × {} m shows {} times as much area across its length as along it, but {} times the intensity",
        "вблизи горизонта у отверстия {} × {} м видимая площадь поперёк длины больше, чем вдоль неё, в {} раза, а сила света – в {} раза",
    ),
    (
        "C0 and C90 seem to be swapped: the luminance at 85° along the length comes out {} times as high as with the planes turned by 90°, and UGR changes with it",
        "похоже, C0 и C90 перепутаны: яркость под углом 85° вдоль длины получается в {} раза выше, чем при плоскостях, повёрнутых на 90°; вместе с ней меняется и UGR",
    ),
    ("{} cd at nadir from {} cm²", "{} кд в надир с площади {} см²"),
    (
        "a luminance of {} cd/m²: UGR is far too high; are the sizes in the right unit?",
        "яркость {} кд/м²: UGR сильно завышен; в тех ли единицах заданы размеры?",
    ),
    (
        "luminous opening {} of {} × {} × {} m (width, length, height; − marks a diameter) is no shape of LM-63, so it is taken as the nearest one, {}",
        "отверстие {} с размерами {} × {} × {} м (ширина, длина, высота; «−» – диаметр) – не форма из LM-63, взята ближайшая: {}",
    ),
    ("a rectangle of negative height as a flat one", "прямоугольник с отрицательной высотой – как плоский"),
    ("a line as a point", "линия – как точка"),
    (
        "luminance and UGR are approximate; illuminance nearer than about ten times its size as well",
        "яркость и UGR приближённые; освещённость на расстоянии менее десяти размеров – тоже",
    ),
    (
        "the luminaire's own size of {} × {} m is taken as its luminous opening",
        "за выходное отверстие приняты габариты светильника {} × {} м",
    ),
    (
        "luminance and UGR are too low where less of it shines; set `area`",
        "яркость и UGR занижены, если светит лишь часть; задайте `area`",
    ),
    // Planes and angles.
    (
        "γ = 0 is one direction, but its planes say {} to {} cd",
        "γ = 0 – одно направление, но по разным плоскостям в нём от {} до {} кд",
    ),
    (
        "the illuminance right below is uncertain by {} %",
        "освещённость прямо под светильником не определена в пределах {} %",
    ),
    ("γ starts at {}°", "γ начинается с {}°"),
    (
        "the cone below is taken as dark: up to about {} % of the flux is missing, right under the luminaire",
        "конус внизу принят тёмным: потеряно примерно до {} % потока, и именно под светильником",
    ),
    ("γ ends at {}°", "γ заканчивается на {}°"),
    (
        "directions beyond are taken as dark: up to about {} % of the flux is missing",
        "направления далее приняты тёмными: потеряно примерно до {} % потока",
    ),
    (
        "{} % of the largest intensity ({} cd) leaves a flat opening edge-on at γ = 90°",
        "{} % наибольшей силы света ({} кд) плоское отверстие излучает вдоль самого себя, при γ = 90°",
    ),
    (
        "its projected area is 0 there: luminance and UGR near the horizon are overstated, by some {} cd/m² at 85°; luminous sides seem to be missing",
        "проекция отверстия там равна 0: яркость и UGR у горизонта завышены, при 85° примерно на {} кд/м²; видимо, не указаны светящие боковины",
    ),
    (
        "{} % of the flux ({} lm) goes up although the opening is flat and faces down",
        "{} % потока ({} лм) идёт вверх, хотя отверстие плоское и обращено вниз",
    ),
    (
        "a flat opening cannot do that: {} lm reach the ceiling that may be stray light of the measurement",
        "плоское отверстие так не светит: на потолок попадают {} лм – возможно, паразитный свет при измерении",
    ),
    (
        "the opening describes at most the lower part: luminance from above is undefined, and UGR attributes all light to that area; illuminance is not affected",
        "отверстие описывает разве что нижнюю часть: яркость сверху не определена, а UGR относит весь свет к этой площади; на освещённость это не влияет",
    ),
    (
        "the file declares a symmetry (line 3) but stores all {} planes, which depart from it by {} % of the largest intensity",
        "файл заявляет симметрию (строка 3), но хранит все плоскости ({}), и они отступают от неё на {} % наибольшей силы света",
    ),
    (
        "all planes are used; programs that trust the symmetry read others",
        "взяты все плоскости; программы, которые верят симметрии, прочтут другие",
    ),
    (
        "line 2 declares symmetry about the vertical axis, but the planes differ by {} % of the largest intensity",
        "строка 2 заявляет симметрию относительно вертикальной оси, но плоскости различаются на {} % наибольшей силы света",
    ),
    (
        "the planes are used, so the luminaire's rotation matters",
        "взяты плоскости, поэтому поворот светильника имеет значение",
    ),
    (
        "the planes at 0° and 360° are one, but differ by {} % of the largest intensity",
        "плоскости 0° и 360° – одна и та же, но различаются на {} % наибольшей силы света",
    ),
    (
        "the one at 0° is used: illuminance on that side is uncertain by as much",
        "взята плоскость 0°: освещённость с этой стороны не определена в тех же пределах",
    ),
    ("the plane at 360° is missing", "нет плоскости 360°"),
    (
        "the one at 0° is used; programs that do not close the circle lose a sector",
        "взята плоскость 0°; программы, которые не замыкают круг, теряют сектор",
    ),
    (
        "{} of the intensities {} all their neighbours; the worst at {}, γ {}°: {} cd among {} cd",
        "силы света ({}) {} всех соседних; худшая – {}, γ {}°: {} кд среди {} кд",
    ),
    ("stand out above", "намного выше"),
    ("fall below", "намного ниже"),
    ("plane {}°", "плоскость {}°"),
    (
        "where this direction meets a surface its illuminance is {} times as high as its surroundings suggest; so is the luminance seen from there",
        "там, куда приходит это направление, освещённость отличается от окружающей в {} раза; так же и яркость, видимая оттуда",
    ),
    ("γ in steps of up to {}° is coarse for this beam", "шаг γ до {}° для такого пучка велик"),
    (
        "the flux is uncertain by about {} % from interpolation alone, the illuminance in the beam by more",
        "только из-за интерполяции поток не определён в пределах {} %, освещённость в пучке – ещё больше",
    ),
    (
        "{} {}° stands where the step of {}° that all others keep asks for {}°",
        "{} {}° стоит там, где по шагу {}°, общему для остальных углов, должно быть {}°",
    ),
    (
        "if it is a misprint, what was measured {}° away is used there, and its neighbours are interpolated towards it",
        "если это опечатка, там взято измеренное на {}° в стороне, и к нему интерполируются соседние значения",
    ),
    ("a luminous area of {} m²", "светящая площадь {} м²"),
    (
        "its luminance is {} cd/m²: UGR and the illuminance near by are far too low; are the sizes in the right unit?",
        "его яркость {} кд/м²: UGR и освещённость вблизи сильно занижены; верна ли единица размеров?",
    ),
    ("{} ends at {}°", "{} кончается на {}°"),
    (
        "there the lamp still shines with {} % of its largest intensity, and directions beyond are taken as dark: flux and illuminance are too low",
        "там светильник светит ещё с {} % наибольшей силы света, а дальше считается тёмным: поток и освещённость занижены",
    ),
    ("'{}' is two numbers in a line that holds one", "«{}» – два числа в строке, где должно быть одно"),
    ("write it without a space, 1200 and not 1 200", "пишите без пробела: 1200, а не 1 200"),
    ("{} photometry, resampled to type C in steps of {}°", "фотометрия {}, пересчитана в тип C с шагом {}°"),
    ("type A", "типа A"),
    ("type B", "типа B"),
    ("type C", "типа C"),
    (
        "intensities are kept within {} % of the largest, the flux within {} %",
        "силы света сохранены с точностью {} % наибольшей, поток – {} %",
    ),
    (
        "the lamp's flux depends on tilt; the first factor, {} at {}°, is applied",
        "поток лампы зависит от наклона; применён первый коэффициент, {} при {}°",
    ),
    (
        "mounted at another tilt, flux and illuminance differ by {} % to {} %",
        "при другом наклоне поток и освещённость изменятся на {} … {} %",
    ),
    ("measured at a tilt of {}°", "измерено при наклоне {}°"),
    (
        "not turned back: the beam points elsewhere unless you aim the luminaire",
        "обратно не повёрнуто: пучок направлен иначе, пока вы не нацелите светильник",
    ),
    // The file itself.
    ("text after the last intensity, from '{}'", "текст после последней силы света, начиная с «{}»"),
    (
        "ignored; if angles were left out of the head, every intensity may be shifted",
        "не учитывается; если в заголовке пропущены углы, все силы света могли сдвинуться",
    ),
    (
        "ignored; if the counts of planes are wrong, every intensity may be shifted",
        "не учитывается; если число плоскостей неверно, все силы света могли сдвинуться",
    ),
    ("{} directions are given twice", "направлений, заданных дважды: {}"),
    (
        "the first value counts; if the others differ, the distribution is uncertain",
        "взято первое значение; если другие отличаются, кривая не определена",
    ),
    ("unknown edition '{}'", "неизвестная редакция «{}»"),
    (
        "read as LM-63-2002; the opening and the ballast-lamp factor may mean something else",
        "прочитано как LM-63-2002; отверстие и поле после коэффициента ПРА могут означать другое",
    ),
    ("{} lines end in CR LF, {} in LF alone", "строк с концом CR LF: {}, только с LF: {}"),
    (
        "read alike here; the file was edited or joined by hand, so look at its values twice",
        "здесь читаются одинаково; файл правили или склеивали вручную, проверьте значения",
    ),
    ("lines end in CR LF, as LM-63 asks for", "строки кончаются на CR LF, как требует LM-63"),
    ("lines end in CR LF", "строки кончаются на CR LF"),
    (
        "no effect here; readers that keep the CR may misread the last number of a line",
        "здесь не влияет; программы, которые не отбрасывают CR, могут неверно прочесть последнее число строки",
    ),
    (
        "a name holds characters beyond ASCII, whose encoding the format does not state",
        "в названии есть символы вне ASCII, а кодировку формат не указывает",
    ),
    (
        "names may be shown wrongly, numbers are not affected",
        "названия могут отображаться неверно, на числа это не влияет",
    ),
    ("{} emitters are added into one distribution", "излучателей: {}, сложены в одну кривую"),
    (
        "they shine from one place: illuminance nearer than about ten times their distance from each other, and the glare of each, are approximate",
        "они светят из одного места: освещённость ближе примерно десяти расстояний между ними и блёскость каждого приближённые",
    ),
    (
        "h = 0° is taken across the luminaire's length, as the schema names its faces",
        "h = 0° принято поперёк длины светильника, как в схеме названы его грани",
    ),
    (
        "where the maker means LM-63's 0° plane, all planes are turned by 90°: crosswise and endwise are exchanged; set `rotate`",
        "если изготовитель имел в виду плоскость 0° по LM-63, все плоскости повёрнуты на 90°: поперёк и вдоль перепутаны; задайте `rotate`",
    ),
    ("the emitter's flux depends on tilt", "поток излучателя зависит от наклона"),
    (
        "not applied: mounted at another tilt, flux and illuminance differ",
        "не учтено: при другом наклоне поток и освещённость изменятся",
    ),
    ("not read: {}", "не прочитано: {}"),
    (
        "light is computed from the luminous intensities alone; nothing depends on the colour of light",
        "свет рассчитывается только по силам света; от цвета света ничего не зависит",
    ),
    ("emitter spectra: {}", "спектры излучателей: {}"),
    ("angular spectra: {}", "спектры по направлениям: {}"),
    ("angular colours: {}", "цвет по направлениям: {}"),
    ("radiant intensities: {}", "силы излучения: {}"),
    ("photon intensities: {}", "фотонные силы: {}"),
    ("illuminances: {}", "освещённости: {}"),
    ("irradiances: {}", "энергетические освещённости: {}"),
    ("photon flux densities: {}", "плотности потока фотонов: {}"),
    ("spectral irradiances: {}", "спектральные энергетические освещённости: {}"),
    ("channel multipliers: {}", "множители каналов: {}"),
    ("luminous areas on top of the luminaire", "светящие площади на верху светильника"),
    (
        "an opening is seen from below here: the luminance from above is undefined",
        "отверстие здесь видно снизу: яркость сверху не определена",
    ),
    (
        "{} luminous areas of {} m² in all are taken as the rectangle around them, {} m²",
        "светящих площадей: {}, всего {} м²; взят прямоугольник вокруг них, {} м²",
    ),
    (
        "luminance is {} times that of the areas themselves, UGR lower by {}",
        "яркость составляет {} от яркости самих площадей, UGR ниже на {}",
    ),
    ("used by the emitters {}", "используется излучателями «{}»"),
    (
        "the product may set another flux per emitter, which is not read",
        "изделие может задавать излучателю другой поток, он не читается",
    ),
    // Values that are undefined.
    (
        "the spacing-to-height ratio must be 1, 1/2 … 1/10, not {}",
        "отношение шага к высоте должно быть 1, 1/2 … 1/10, а не {}",
    ),
    ("the luminaire has no flux", "у светильника нет потока"),
    (
        "the room needs positive sizes and reflectances between 0 and 1",
        "нужны положительные размеры помещения и коэффициенты отражения от 0 до 1",
    ),
    (
        "{} % of the flux goes up, the luminaire is indirect",
        "{} % потока идёт вверх, это светильник отражённого света",
    ),
    ("the luminous area of {} m² is larger than {} m²", "светящая площадь {} м² больше {} м²"),
    (
        "the intensities on either side of an axis differ by {} % of the largest",
        "силы света по разные стороны оси различаются на {} % наибольшей",
    ),
    ("no light in this plane", "в этой плоскости нет света"),
    (
        "the intensity falls nowhere below {} % of the largest in this plane",
        "сила света в этой плоскости нигде не падает ниже {} % наибольшей",
    ),
    ("no light goes down", "свет вниз не идёт"),
    ("no luminous area is seen from γ = 85°", "с направления γ = 85° светящая площадь не видна"),
    ("no luminous area is seen from there", "оттуда светящая площадь не видна"),
    ("no planes", "плоскостей нет"),
    ("no light at nadir", "в надир свет не идёт"),
    ("the illuminance does not fall towards the horizon", "освещённость к горизонту не падает"),
    (
        "no luminous area, so no luminance and no UGR; see `gershun explain zero-area`",
        "светящей площади нет, поэтому нет ни яркости, ни UGR; см. `gershun explain zero-area`",
    ),
];

#[cfg(test)]
#[path = "findings_tests.rs"]
mod tests;
