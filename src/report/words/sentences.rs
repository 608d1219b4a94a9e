//! Sentences that the solver and the loader say – reasons, biases, notes – in other languages. They
//! are English inside the program and in files for machines; what people read is looked up here by
//! its pattern, `{}` standing for names and numbers. A sentence that is not in the table stays English:
//! `untranslated` tells, and a test runs it over the bundled scenes.

use std::borrow::Cow;

use super::Lang;
use super::findings::finding;

/// Patterns in English and Russian, more special ones first where two could match.
pub const SENTENCES: &[(&str, &str)] = &[
    // Reasons of the plan.
    (
        "{} receivers and {} lines of sight ask for a stored field: light is solved once, then looked up.",
        "Расчётных точек: {}, лучей зрения: {}; поле яркости рассчитывается один раз и хранится, ответы берутся из него.",
    ),
    (
        "Every surface stores one number a side: all scattering materials are diffuse, so their luminance has no direction.",
        "Для каждой стороны поверхности хранится одно число: все рассеивающие материалы диффузные, их яркость не зависит от направления.",
    ),
    (
        "Every scattering surface stores one number a side, the luminance of its diffuse part, which has no direction. The highlights of {} glossy surfaces are not stored: their lobe is drawn at every look, luminaires in it by their openings as well.",
        "Для каждой стороны рассеивающей поверхности хранится одно число – яркость диффузной части, не зависящая от направления. Блики глянцевых поверхностей ({}) не хранятся: направленная составляющая разыгрывается при каждом взгляде, светильники в ней – также по точкам их отверстий.",
    ),
    (
        "Area \"{}\" lies at {} m, row {} names a plane at {} m.",
        "Область «{}» лежит на высоте {} м, строка {} называет плоскость на высоте {} м.",
    ),
    (
        "{} specular surfaces store nothing: rays are followed through them, and luminaires are imaged in their planes.",
        "Для зеркальных и прозрачных поверхностей ({}) ничего не хранится: лучи прослеживаются через них, светильники отражаются в их плоскостях.",
    ),
    (
        "No surface is specular: rays end at the first surface.",
        "Зеркальных поверхностей нет: луч заканчивается на первой поверхности.",
    ),
    (
        "{} channels are solved at once; {} light scenes and the maintenance factors are weights on them.",
        "Каналов, рассчитываемых вместе: {}; световые сцены ({}) и коэффициенты эксплуатации – их весовые множители.",
    ),
    (
        "Room \"{}\" lists no areas: {} were made from its outline (working plane, walls, ceiling, volume).",
        "Для помещения «{}» области не заданы: по его контуру построены {} (рабочая плоскость, стены, потолок, объём).",
    ),
    (
        "Area \"{}\": {} of {} points lie inside furniture and are left out.",
        "Область «{}»: {} из {} точек лежат внутри мебели и исключены.",
    ),
    (
        "no block has found reflected or emitted light here, though surfaces reflect or shine: there is no upper end",
        "ни один блок не нашёл здесь отражённого или излучённого поверхностями света, хотя поверхности отражают или светят: верхней границы нет",
    ),
    (
        "few rays have met what comes from luminaires by two mirrors, one after the other: the upper end allows for all of it",
        "свет светильников, приходящий через два зеркала подряд, встретили лишь немногие лучи: верхняя граница учитывает его целиком",
    ),
    (
        "Light of luminaires that comes by two or more mirrors, one after the other, and that of luminous surfaces by any mirror, is found by chance.",
        "Свет светильников, приходящий через два и более зеркала подряд, и свет светящих поверхностей, приходящий через зеркало, находится случайно.",
    ),
    (
        "intervals may miss what is rare; at points and areas their upper ends allow for what they send there straight",
        "интервалы могут не учесть редкое; в точках и областях верхняя граница учитывает то, что приходит от них прямо",
    ),
    ("maintained", "эксплуатационные значения"),
    // Notes of a view.
    (
        "luminous surfaces: emitted light in pieces with their own position index; what they reflect belongs to the background",
        "светящие поверхности: излучённый свет по частям, каждая со своим индексом позиции; отражённый ими свет отнесён к фону",
    ),
    (
        "highlights in glossy planes are sources where they exceed {} E_v/π; others, and what is fainter, belong to the background",
        "блики в глянцевых плоскостях – источники там, где их яркость выше {} E_v/π; прочие и более слабые отнесены к фону",
    ),
    (
        "highlights on glossy surfaces belong to the background",
        "блики на глянцевых поверхностях отнесены к фону",
    ),
    // Biases of solving.
    (
        "Unshadowed light of openings is integrated numerically.",
        "Свет выходных отверстий без учёта затенения интегрируется численно.",
    ),
    (
        "Path tracing finds small bright places by chance.",
        "Трассировка путей находит малые яркие места случайно.",
    ),
    (
        "Local estimation finds small bright places and luminous surfaces by chance.",
        "Локальная оценка находит малые яркие места и светящие поверхности случайно.",
    ),
    (
        "value and interval may both lack what is rare; the method links aims at it",
        "редкого света может недоставать и в значении, и в интервале; метод links целится в него",
    ),
    ("at most about {} of each luminaire's illuminance", "не более {} освещённости от каждого светильника"),
    (
        "Light of point sources that reaches diffuse surfaces only by two or more specular reflections, or by curved mirrors, is left out.",
        "Не учтён свет точечных источников, попадающий на диффузные поверхности лишь после двух и более зеркальных отражений или через кривые зеркала.",
    ),
    ("{} % of the luminous flux (measured)", "{} % светового потока (измерено)"),
    (
        "Images of bright surfaces that do not emit, and images by more than one reflection, are part of the background, not glare sources.",
        "Отражения ярких, но не светящих поверхностей и отражения более чем однократные отнесены к фону, а не к блёским источникам.",
    ),
    (
        "{} specular planes; images of luminaires and luminous surfaces by one reflection in them do count as glare sources",
        "зеркальных плоскостей: {}; однократные отражения светильников и светящих поверхностей в них учтены как блёские источники",
    ),
    (
        "Opal surfaces lit from behind are part of the background, not glare sources.",
        "Просвечиваемые опаловые поверхности отнесены к фону, а не к блёским источникам.",
    ),
    (
        "observers' UGR reads low where one is bright",
        "UGR наблюдателей занижен, если такая поверхность яркая",
    ),
    (
        "Highlights on glossy surfaces that are dull, curved or small, and those of luminous surfaces, are part of the background, not glare sources.",
        "Блики на тусклых, изогнутых и малых глянцевых поверхностях и блики светящих поверхностей отнесены к фону, а не к блёским источникам.",
    ),
    ("observers' UGR reads low where one dazzles", "UGR наблюдателей занижен там, где блик слепит"),
    (
        "The lobe of phong_paper loses light at grazing incidence that a real surface reflects; `phong` does not.",
        "Модель phong_paper теряет при скользящем падении свет, который реальная поверхность отражает; `phong` – нет.",
    ),
    (
        "{} % of the reflectance `specular` under uniform light",
        "{} % коэффициента `specular` при равномерном освещении",
    ),
    ("Luminous surfaces shine on both sides.", "Светящиеся поверхности излучают в обе стороны."),
    (
        "light of a side that faces out of the room counts as emitted and escaped in the flux balance",
        "свет стороны, обращённой наружу, входит в баланс потоков как излучённый и вышедший",
    ),
    (
        "A dimmed luminaire is taken to need power in proportion to its light.",
        "Принято, что мощность диммированного светильника пропорциональна его свету.",
    ),
    (
        "real gear needs more when dimmed: W/m² per 100 lx, and what dimming saves, flatter",
        "реальная аппаратура при диммировании потребляет больше: Вт/м² на 100 лк и экономия от диммирования приукрашены",
    ),
    ("Walks in a cavity without absorption were cut.", "Блуждания в полости без поглощения были оборваны."),
    ("{} walks", "блужданий: {}"),
    (
        "Some rays left the scene: it is open, or its surfaces do not meet.",
        "Часть лучей вышла из сцены: она открыта или её поверхности не смыкаются.",
    ),
    ("{} % of all rays; see the escaped flux", "{} % всех лучей; см. вышедший поток"),
    ("not quantified", "не оценено количественно"),
    ("{}: up to {} % of the value; the margin is {} %", "{}: до {} % значения; запас {} %"),
    ("{}: {}; the margin is {} %", "{}: {}; запас {} %"),
    // Biases of loading.
    (
        "glare maps are computed by `gershun glare`, not by check",
        "карты блёскости рассчитывает команда `gershun glare`, а не check",
    ),
    (
        "{}: {} triangles repeat another one of their surface (double-sided faces) and were dropped",
        "{}: треугольников, повторяющих другой того же объекта (двусторонние грани), отброшено: {}",
    ),
    ("{}: {} triangles without area were dropped", "{}: треугольников без площади отброшено: {}"),
    (
        "{} light sources of {} are ignored ({}); `lights = true` in [scene] makes them luminaires",
        "источников света: {} – файла {} не используются ({}); `lights = true` в [scene] делает их светильниками",
    ),
    (
        "{}: its node is mirrored, the photometric file is not",
        "{}: узел зеркально отражён, фотометрический файл – нет",
    ),
    (
        "{}: its range of {} m is ignored, light goes on",
        "{}: его дальность {} м не учитывается, свет идёт дальше",
    ),
    (
        "{} is directional and ignored: daylight is not computed",
        "{} – направленный источник, не используется: естественный свет не рассчитывается",
    ),
    (
        "luminaire \"{}\": up to {} % of its luminous body lies behind a surface ({} placed so), and that light is lost; its centre hangs at `at`, so lower it by half its luminous height, name its housing in `body`, or give it a flat `area`",
        "светильник «{}»: до {} % его светящегося тела лежит за поверхностью (размещено так: {}), этот свет теряется; в `at` задаётся центр тела: опустите его на половину светящейся высоты, назовите корпус в `body` или задайте плоскую `area`",
    ),
    ("{}: morph targets of the glTF file are ignored", "{}: морфинг-цели файла glTF не используются"),
    (
        "{}: the file names no default scene; its first one was read",
        "{}: в файле не названа сцена по умолчанию; прочитана первая",
    ),
    ("nothing emits light in {}", "в сцене {} ничто не излучает свет"),
    (
        "room \"{}\": the geometry is flat, {} m × {} m × {} m",
        "помещение «{}»: геометрия плоская, {} м × {} м × {} м",
    ),
    (
        "room \"{}\": faces of the shell look outwards; both sides reflect alike",
        "помещение «{}»: грани оболочки обращены наружу; обе стороны отражают одинаково",
    ),
    // Notes on glare.
    ("initial, direct light only", "начальные значения, только прямой свет"),
    ("initial", "начальные значения"),
    ("maintained, direct light only", "эксплуатационные значения, только прямой свет"),
    (
        "emergency output, maintained, direct light only",
        "аварийный режим, эксплуатационные значения, только прямой свет",
    ),
    ("emergency output, maintained", "аварийный режим, эксплуатационные значения"),
    ("emergency output, initial", "аварийный режим, новая установка"),
    (
        "Room \"{}\" is dark in an emergency: none of its luminaires has an output then (`emergency`).",
        "Помещение «{}» в аварийном режиме тёмное: ни у одного светильника не задан аварийный поток (`emergency`).",
    ),
    // What norms ask for and nothing computes.
    (
        "response time: half of the light within 5 s, all of it within 60 s (two sources)",
        "время включения: половина освещённости через 5 с, полная через 60 с (два источника)",
    ),
    (
        "response time: half of the light within 5 s, all of it within 60 s (one source)",
        "время включения: половина освещённости через 5 с, полная через 60 с (один источник)",
    ),
    ("duration: at least 1 h (one source)", "продолжительность: не менее 1 ч (один источник)"),
    (
        "mounting: luminaires at 2 m and higher (one source)",
        "установка: светильники на высоте 2 м и выше (один источник)",
    ),
    (
        "response time: all of the light at once or within 0.5 s (two sources)",
        "время включения: полная освещённость сразу или через 0,5 с (два источника)",
    ),
    (
        "response time: all of the light within 0.5 s (one source)",
        "время включения: полная освещённость через 0,5 с (один источник)",
    ),
    (
        "duration: as long as the risk lasts (one source)",
        "продолжительность: пока сохраняется опасность (один источник)",
    ),
    ("no stroboscopic effect (one source)", "без стробоскопического эффекта (один источник)"),
    ("colour temperature from {} K to {} K", "цветовая температура от {} К до {} К"),
    ("contrast of the edges of steps", "контраст кромок ступеней"),
    ("safety colours must be recognisable", "сигнальные цвета должны быть различимы"),
    ("stroboscopic effects are to be avoided", "следует избегать стробоскопического эффекта"),
    (
        "illuminance: set by the exhibition and by the protection of the exhibits",
        "освещённость: определяется экспозицией и защитой экспонатов",
    ),
    ("illuminance: set by the exhibition", "освещённость: определяется экспозицией"),
    (
        "illuminance: the norm asks for a fitting atmosphere",
        "освещённость: норма требует подходящей атмосферы",
    ),
    (
        "a tenth of the task's maintained illuminance is required where that is more than 15 lx: ask for it with [[require]]",
        "требуется десятая часть эксплуатационной освещённости рабочей области, если она больше 15 лк: задайте её в [[require]]",
    ),
    ("{}; {}; L_b = E_ind/π", "{}; {}; L_b = E_отр/π"),
    ("L_b = E_ind/π", "L_b = E_отр/π"),
    ("initial flux", "начальный поток"),
    ("DGP with evalglare's coefficients (0.092, 0.159)", "DGP с коэффициентами evalglare (0,092; 0,159)"),
    (
        "DGP with the published coefficients (0.0918, 0.16)",
        "DGP с опубликованными коэффициентами (0,0918; 0,16)",
    ),
    ("{}, low-light factor", "{}, с множителем для малой освещённости"),
    ("an eye of {} years, pigment {}", "глаз в возрасте {} лет, пигментация {}"),
    ("an eye of {} years", "глаз в возрасте {} лет"),
    ("far field of the opening's centre", "дальняя зона, центр отверстия"),
    ("visible part, mean luminance", "видимая часть, средняя яркость"),
    ("visible part, subdivided", "видимая часть, по элементам"),
    (
        "position index CIE 117 table (Iwata–Osterhaus below the line of sight)",
        "индекс позиции по таблице CIE 117 (ниже линии зрения – Ивата–Остерхаус)",
    ),
    (
        "position index Levin (Iwata–Osterhaus below the line of sight)",
        "индекс позиции по Левину (ниже линии зрения – Ивата–Остерхаус)",
    ),
    (
        "the task is a cone of {}° about the line of sight, its surround up to {}° and the far field up to {}° from its middle",
        "рабочее поле – конус {}° вокруг линии зрения, его окружение – до {}°, периферия – до {}° от середины поля",
    ),
    (
        "the task is a cone of {}° at {}° from the line of sight, its surround up to {}° and the far field up to {}° from its middle",
        "рабочее поле – конус {}° под углом {}° к линии зрения, его окружение – до {}°, периферия – до {}° от середины поля",
    ),
    (
        "what of the zones lies behind the plane of the eye is left out",
        "то, что лежит позади плоскости зрачка, в зоны не входит",
    ),
    ("the task lies behind the eye", "рабочее поле лежит позади глаза"),
    (
        "directions that have the task behind the eye are left out",
        "направления, при которых рабочее поле лежит позади глаза, не учтены",
    ),
    ("the surround of the task is dark", "окружение рабочего поля тёмное"),
    ("the far field is dark", "периферия поля зрения тёмная"),
    (
        "sources with a size count by their parts, each at its own angle, within about 2 %",
        "источники, имеющие размер, учтены по частям, каждая под своим углом, с погрешностью около 2 %",
    ),
    (
        "{} source(s) outside {}° to {}°, where the form holds",
        "источников: {} – вне пределов {}°…{}°, в которых формула действительна",
    ),
    (
        "{} % of the light of sources that count in parts lies outside {}° to {}°, where the form holds",
        "{} % света источников, учтённых по частям, приходит вне пределов {}°…{}°, в которых формула действительна",
    ),
    (
        "what a source shows within 0.1° of the line of sight is looked at, does not stray and is left out",
        "то, что источник показывает ближе 0,1° к линии зрения, рассматривается, не рассеивается и не учтено",
    ),
    ("a source lies within 0.1° of the line of sight", "источник лежит в пределах 0,1° от линии зрения"),
    (
        "a point source has no luminance, for which this index asks",
        "у точечного источника нет яркости, которая нужна этому показателю",
    ),
    ("the illuminance at the eye is not positive", "освещённость у глаза не положительна"),
    ("there is no indirect light at the eye", "отражённого света у глаза нет"),
    ("the mean luminance of the field of view is not known", "средняя яркость поля зрения неизвестна"),
    (
        "a room has no road: f_TI needs its mean luminance (`road` of the viewpoint)",
        "в помещении нет дороги: для f_TI нужна её средняя яркость (`road` точки наблюдения)",
    ),
    ("the field of view is dark", "поле зрения тёмное"),
    ("it was not asked for", "не запрашивалось"),
    (
        "the mean luminance of the field of view is not computed from a kept field: leave `--field` out, or run `check`",
        "средняя яркость поля зрения по сохранённому полю яркости не рассчитывается: уберите `--field` или запустите `check`",
    ),
    (
        "luminances of task and surround are not computed from a kept field: leave `--field` out, or run `check`",
        "яркости рабочего поля и окружения по сохранённому полю яркости не рассчитываются: уберите `--field` или запустите `check`",
    ),
    ("the eyes of a map have no task", "у глаз карты нет рабочего поля"),
    (
        "maps do not compute it: list a viewpoint, and run `check`",
        "для карт не рассчитывается: задайте точку наблюдения и запустите `check`",
    ),
    (
        "field of view: a cone of 5 sr, {}° about the line of sight, luminaires included",
        "поле зрения – конус 5 ср, {}° от линии зрения, вместе со светильниками",
    ),
    ("the share of the ceiling that shines is not given", "доля светящейся части потолка не задана"),
    ("nothing of the ceiling shines", "потолок не светится ни в одной части"),
    ("{} of the ceiling shines", "доля светящейся части потолка {}"),
    ("{} of the ceiling shines, as given", "доля светящейся части потолка {}, задана"),
    (
        "ground of {} lx, reflectance {}, as given",
        "освещаемая площадь с {} лк, коэффициент отражения {}, заданы",
    ),
    (
        "GGR is made for luminous shares of the ceiling from {} to {}, here {}; below them UGR holds",
        "GGR создан для доли светящейся части потолка от {} до {}, здесь {}; при меньшей действует UGR",
    ),
    (
        "GR is rated against the illuminance of an area, which `gershun check` computes",
        "GR оценивается относительно освещённости области, которую рассчитывает `gershun check`",
    ),
    ("the area has no horizontal illuminance", "для области нет горизонтальной освещённости"),
    (
        "no area of the room has a horizontal illuminance, against which GR rates glare",
        "ни у одной области помещения нет горизонтальной освещённости, относительно которой оценивается GR",
    ),
    (
        "the room has several areas: name that of the viewpoint (`ground = { area = … }`)",
        "в помещении несколько областей: назовите область точки наблюдения (`ground = { area = … }`)",
    ),
    (
        "nothing lies under the area whose reflectance could be taken (`ground = { reflectance = … }`)",
        "под областью нет поверхности, коэффициент отражения которой можно взять (`ground = { reflectance = … }`)",
    ),
    (
        "area \"{}\" of {} lx at initial flux, reflectance {}",
        "область «{}»: {} лк при начальном потоке, коэффициент отражения {}",
    ),
    (
        "CIE 112 has GR for lines of sight below the horizontal",
        "CIE 112 определяет GR для линий зрения ниже горизонта",
    ),
    (
        "the norm rates GR at observers of its own, which gershun does not lay: list viewpoints and require GR of them",
        "норма оценивает GR в собственных точках наблюдения, которые gershun не расставляет: задайте точки наблюдения и потребуйте GR для них",
    ),
    (
        "the ground's reflectance and mean horizontal illuminance are not given",
        "коэффициент отражения и средняя горизонтальная освещённость земли не заданы",
    ),
    ("the road's mean luminance L_av is not given", "средняя яркость дорожного покрытия L_av не задана"),
    ("{} source(s) beyond 60° are left out", "источников далее 60°: {} – исключены"),
    (
        "{} source(s) under {} sr; DGI was made for windows",
        "источников: {} – под телесным углом менее {} ср; DGI создан для окон",
    ),
    (
        "{} source(s) nearer than 1.5° to the line of sight, where 10 E/θ² does not hold",
        "источников: {} – ближе 1,5° к линии зрения, где 10 E/θ² не выполняется",
    ),
    (
        "VCP was made for lensed ceiling luminaires of uniform luminance, not for windows or lamps",
        "VCP создан для потолочных светильников равномерной яркости, а не для окон и ламп",
    ),
    (
        "E_v {} lx is below the {} lx from which on DGP holds",
        "E_v {} лк меньше {} лк, начиная с которых действует DGP",
    ),
    ("DGP was fitted between {} and {}", "DGP подобран в пределах от {} до {}"),
    (
        "UGP lies outside 0 to 1: beyond the offices it was fitted to",
        "UGP вне пределов 0…1: за рамками офисов, для которых он подобран",
    ),
    (
        "a source lies below the line of sight: Iwata–Osterhaus position index",
        "источник ниже линии зрения: индекс позиции по Ивата–Остерхаусу",
    ),
    ("{} source(s) {}", "источников: {} – {}"),
    (
        "seen under less than {} sr, where UGR is not validated",
        "видны под телесным углом менее {} ср, где UGR не проверен",
    ),
    (
        "seen under more than {} sr, where UGR is not validated",
        "видны под телесным углом более {} ср, где UGR не проверен",
    ),
    (
        "with more than {} m² of projected area, which UGR understates",
        "с площадью проекции более {} м², которые UGR недооценивает",
    ),
    ("no light source is visible", "источники света не видны"),
    (
        "all visible sources lie where the CIE 117 table has no position index, so UGR counts none",
        "все видимые источники лежат там, где в таблице CIE 117 нет индекса позиции: UGR их не учитывает",
    ),
    (
        "a source, or a part of one, lies where the CIE 117 table has no position index: UGR leaves it out, other indices take P by Levin",
        "источник или его часть лежит там, где в таблице CIE 117 нет индекса позиции: UGR его не учитывает, прочие показатели берут P по Левину",
    ),
    ("the background luminance is not positive", "яркость фона не положительна"),
    ("a source has no finite luminance", "у источника нет конечной яркости"),
    ("a source has no valid position index", "у источника нет допустимого индекса позиции"),
    ("the viewpoint has no direction", "у точки наблюдения нет направления взгляда"),
    // The table method.
    ("the room has no luminaire", "в помещении нет светильников"),
    ("not computed", "не рассчитано"),
    (
        "table method not applicable: luminaires are not aimed straight down",
        "табличный метод неприменим: светильники направлены не вертикально вниз",
    ),
    (
        "table method not applicable: luminaires hang at different heights or below the eye",
        "табличный метод неприменим: светильники висят на разной высоте или ниже глаз",
    ),
    (
        "table method not applicable: the luminaire has no luminous area",
        "табличный метод неприменим: у светильника не задана светящая площадь",
    ),
    (
        "table method not applicable: the room is not rectangular",
        "табличный метод неприменим: помещение не прямоугольное",
    ),
    (
        "table method not applicable: bright luminous surfaces shine in the room",
        "табличный метод неприменим: в помещении есть яркие светящиеся поверхности",
    ),
    (
        "the norm asks for daylight; gershun computes none",
        "норма требует естественного света; gershun его не рассчитывает",
    ),
    (
        "table method CIE 190, SHR {}, worst direction, initial flux; {}",
        "табличный метод CIE 190, SHR {}, худшее направление, начальный поток; {}",
    ),
    ("the UGR table method does not apply: {}", "табличный метод UGR неприменим: {}"),
    ("table not applicable: asymmetric luminaire", "таблица неприменима: светильник несимметричный"),
    (
        "luminaires are turned: the worse of both directions of the room is taken",
        "светильники повёрнуты: взято худшее из двух направлений помещения",
    ),
    ("reflectances {} taken for {}", "коэффициенты отражения {} приняты вместо {}"),
    (
        "room {} H × {} H lies outside the table, nearest rooms taken",
        "помещение {} H × {} H вне таблицы, взяты ближайшие",
    ),
    (
        "table method CIE 190, SHR {}, worst direction, initial flux",
        "табличный метод CIE 190, SHR {}, худшее направление, начальный поток",
    ),
    (
        "M = 10^((UGR + 4.8)/16), UGR by the table method, SHR {}",
        "M = 10^((UGR + 4,8)/16), UGR табличным методом, SHR {}",
    ),
    // Undefined values.
    ("E_max is 0", "E_max равна 0"),
    ("no light arrives on the area: 0/0", "на область не падает свет: 0/0"),
    ("the area has no point", "в области нет точек"),
    (
        "an area has no single value: ask for its mean, min, max, U0 or Ud",
        "у области нет одного значения: запросите mean, min, max, U0 или Ud",
    ),
    (
        "not declared for every luminaire type ([declared] {})",
        "заявлено не для каждого типа светильников ([declared] {})",
    ),
    (
        "gershun does not compute this quantity of a room",
        "gershun не рассчитывает эту величину для помещения",
    ),
    ("gershun does not compute this quantity", "gershun не рассчитывает эту величину"),
    (
        "luminaire \"{}\" hangs at ({}, {}, {}) more than once; their light adds up",
        "светильник «{}» подвешен в точке ({}, {}, {}) более одного раза; световые потоки складываются",
    ),
    (
        "luminaire \"{}\" has a maintenance of its own: {} of room \"{}\" does not hold for it",
        "у светильника «{}» собственный коэффициент эксплуатации: {} помещения «{}» на него не действует",
    ),
    ("room \"{}\" measures {} m × {} m × {} m", "размеры помещения «{}»: {} м × {} м × {} м"),
    (
        "no row of the norm is given: name one in the room, its areas or [norm]",
        "строка нормы не указана: назовите её для помещения, его областей или в [norm]",
    ),
    (
        "area at {} m, the row names a plane at {} m",
        "область на высоте {} м, строка называет плоскость на высоте {} м",
    ),
    ("the norm's file has no value of {} for row {}", "в файле нормы нет значения {} для строки {}"),
    (
        "the norm judges UGR at observers and the project lists no viewpoint here",
        "норма оценивает UGR у наблюдателей, а в проекте здесь нет точек наблюдения",
    ),
    (
        "the project lists no task area of row {} in this room",
        "в проекте для этого помещения не задана рабочая область строки {}",
    ),
    (
        "the project lists no volume at {} m, the eye height of the row",
        "в проекте не задан объём на высоте {} м – высоте глаз для этой строки",
    ),
    (
        "row {} speaks of a part of the room: list that part as an area",
        "строка {} относится к части помещения: задайте эту часть как область",
    ),
    ("the project lists no {} round this task area", "вокруг этой рабочей области в проекте не задано: {}"),
    (
        "areas cover only {} % of the {} round this task area",
        "области покрывают лишь {} % зоны вокруг этой рабочей области: {}",
    ),
    (
        "volumes at {} m lie over only {} % of this task area",
        "объёмы на высоте {} м лежат лишь над {} % этой рабочей области",
    ),
    ("areas cover only {} % of this wall", "области покрывают лишь {} % этой стены"),
    ("areas cover only {} % of this ceiling", "области покрывают лишь {} % потолка"),
    ("no area lies on this wall", "на этой стене нет области"),
    ("no area lies on this ceiling", "на потолке нет области"),
    ("the project lists no {} in this room", "в проекте для этого помещения не задано: {}"),
    ("Isotropic point source", "изотропный точечный источник"),
    ("Lambertian source", "источник по закону Ламберта"),
    ("point of the CAD file", "точечный источник из файла CAD"),
    ("spot of the CAD file", "прожектор из файла CAD"),
    ("task area", "рабочая область"),
    ("surrounding area", "зона непосредственного окружения"),
    ("background area", "зона периферии"),
    ("wall", "стена"),
    ("ceiling", "потолок"),
    ("volume", "объём"),
    (
        "the row is for a vertical plane and this area is horizontal",
        "строка относится к вертикальной плоскости, а область горизонтальная",
    ),
    (
        "the area names no task area to compare with (`of`)",
        "для области не названа рабочая область для сравнения (`of`)",
    ),
    ("no light arrives on the task area: 0/0", "на рабочую область не падает свет: 0/0"),
    ("nothing of it is judged yet: {}", "пока не оценивается: {}"),
    ("the norm's row has no limit", "строка нормы не содержит предела"),
    ("the quantity is undefined where no light arrives", "величина не определена там, куда не падает свет"),
    (
        "set aside, the project has a limit of its own: {}",
        "не применяется, в проекте задан собственный предел: {}",
    ),
    ("{} is not measured on this area", "{} на этой области не измеряется"),
    (
        "a room has no grid of its own: name one of its areas",
        "у помещения нет собственной сетки: назовите одну из его областей",
    ),
];

/// A sentence in the reader's language; English where no pattern matches.
pub fn said(lang: Lang, text: &str) -> Cow<'_, str> {
    match lang {
        Lang::En => Cow::Borrowed(text),
        Lang::Ru => {
            let known = look_up(&[SENTENCES], text).or_else(|| of_a_file(text));
            known.map_or(Cow::Borrowed(text), Cow::Owned)
        }
    }
}

/// `file:line: message: consequence`, a finding of a photometric file among the notes of loading.
fn of_a_file(text: &str) -> Option<String> {
    text.match_indices(": ").find_map(|(place, _)| {
        let told = &text[place + 2..];
        told.match_indices(": ").find_map(|(end, _)| {
            let [message, consequence] = [&told[..end], &told[end + 2..]].map(finding);
            Some(format!("{}: {}: {}", &text[..place], message?, consequence?))
        })
    })
}

/// Patterns in English and in another language.
pub(super) type Patterns = [(&'static str, &'static str)];

/// A sentence, or a list of sentences, by tables of patterns; `None` where none is known.
pub(super) fn look_up(tables: &[&Patterns], text: &str) -> Option<String> {
    one(tables, text).or_else(|| one_by_one(tables, text))
}

/// A list of sentences, each looked up on its own; `None` where none is known.
fn one_by_one(tables: &[&Patterns], text: &str) -> Option<String> {
    let parts: Vec<&str> = text.split("; ").collect();
    let found: Vec<Option<String>> = parts.iter().map(|part| one(tables, part)).collect();
    if parts.len() < 2 || found.iter().all(Option::is_none) {
        return None;
    }
    let said: Vec<String> =
        parts.iter().zip(found).map(|(part, found)| found.unwrap_or_else(|| (*part).to_owned())).collect();
    Some(said.join("; "))
}

fn one(tables: &[&Patterns], text: &str) -> Option<String> {
    tables.iter().copied().flatten().find_map(|(english, target)| {
        // A closing full stop belongs to the place where the sentence is printed.
        let stopped = english.strip_suffix('.').filter(|_| !text.ends_with('.'));
        let parts = captured(stopped.unwrap_or(english), text)?;
        let target = if stopped.is_some() { target.trim_end_matches('.') } else { target };
        let mut before = english.split("{}");
        let mut pieces = target.split("{}");
        let mut whole = pieces.next().unwrap_or_default().to_owned();
        for (part, piece) in parts.iter().zip(pieces) {
            // What a file says is quoted as it is, and row 12.1 of a norm is no number.
            let named = before.next().is_some_and(|english| english.ends_with("row "));
            let quoted = named || whole.ends_with('«');
            whole.push_str(&if quoted { (*part).to_owned() } else { translated(tables, part) });
            whole.push_str(piece);
        }
        Some(whole)
    })
}

/// Numbers get a decimal comma; a part that is itself a sentence is looked up.
fn translated(tables: &[&Patterns], part: &str) -> String {
    let bare = part.trim_start_matches('C').trim_end_matches('°');
    if bare.parse::<f64>().is_ok() {
        return part.replace('.', ",");
    }
    look_up(tables, part).unwrap_or_else(|| part.to_owned())
}

/// What stands at each `{}` of the pattern; `None` if the text does not follow it.
fn captured<'t>(pattern: &str, text: &'t str) -> Option<Vec<&'t str>> {
    let mut pieces = pattern.split("{}");
    let mut rest = text.strip_prefix(pieces.next()?)?;
    let mut parts = Vec::new();
    let mut pieces = pieces.peekable();
    while let Some(piece) = pieces.next() {
        let at = match (piece.is_empty(), pieces.peek()) {
            (true, None) => rest.len(),
            (_, None) => rest.len().checked_sub(piece.len()).filter(|&at| rest.is_char_boundary(at))?,
            (_, Some(_)) => rest.find(piece)?,
        };
        if &rest[at..] != piece && pieces.peek().is_none() && !piece.is_empty() {
            return None;
        }
        parts.push(&rest[..at]);
        rest = &rest[(at + piece.len()).min(rest.len())..];
    }
    rest.is_empty().then_some(parts)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_and_numbers_are_carried_over() {
        let text = "Area \"Стол 1\": 3 of 12 points lie inside furniture and are left out.";
        assert_eq!(said(Lang::Ru, text), "Область «Стол 1»: 3 из 12 точек лежат внутри мебели и исключены.");
        assert_eq!(said(Lang::En, text), text);
        assert_eq!(
            said(Lang::Ru, "0.0123 % of all rays; see the escaped flux"),
            "0,0123 % всех лучей; см. вышедший поток"
        );
        assert_eq!(
            said(Lang::Ru, "the norm's file has no value of u0 for row 12.1"),
            "в файле нормы нет значения u0 для строки 12.1"
        );
        let plane = "Area \"A\" lies at 0.80 m, row 34.2 names a plane at 0.75 m.";
        assert!(said(Lang::Ru, plane).contains("строка 34.2") && said(Lang::Ru, plane).contains("0,75"));
        assert_eq!(said(Lang::Ru, "nobody says this"), "nobody says this");
        // A sentence within a sentence, its full stop cut.
        assert_eq!(
            said(
                Lang::Ru,
                "Luminous surfaces shine on both sides: up to 0.50 % of the value; the margin is 1.2 %"
            ),
            "Светящиеся поверхности излучают в обе стороны: до 0,50 % значения; запас 1,2 %"
        );
    }

    /// Catches: findings of photometric files that stay English in a Russian report.
    #[test]
    fn findings_among_the_notes_are_translated() {
        let note = "a.ldt:29: rated 3772 lm, integrates to 3598 lm: Ē is 4.6 % lower than the rated flux suggests; \
                    set `flux` to choose";
        let said = said(Lang::Ru, note);
        assert!(
            said.starts_with("a.ldt:29: заявлено 3772 лм") && said.contains(": Ē на 4,6 % ниже"),
            "{said}"
        );
    }

    /// Catches: a number that changes places or gets lost between the languages.
    #[test]
    fn both_languages_have_the_same_parts() {
        for (english, russian) in SENTENCES {
            assert_eq!(english.matches("{}").count(), russian.matches("{}").count(), "{english}");
            assert_ne!(english, russian);
            let mut filled = english.to_string();
            for number in 1..=english.matches("{}").count() {
                filled = filled.replacen("{}", &(1000 + number).to_string(), 1);
            }
            let translated = said(Lang::Ru, &filled);
            let mut from = 0;
            for number in 1..=english.matches("{}").count() {
                let at = translated[from..].find(&(1000 + number).to_string());
                assert!(at.is_some(), "{english} → {translated}");
                from += at.unwrap_or(0);
            }
        }
    }

    /// Catches: a sentence reworded in the program whose translation is then never found.
    #[test]
    fn every_pattern_is_said_somewhere() {
        let mut source = String::new();
        let mut folders =
            ["src", "standards"].map(|f| std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(f)).to_vec();
        while let Some(folder) = folders.pop() {
            for entry in std::fs::read_dir(folder).expect("src is there").flatten() {
                if entry.path().is_dir() {
                    folders.push(entry.path());
                } else if !entry.path().ends_with("sentences.rs") {
                    source.push_str(&std::fs::read_to_string(entry.path()).expect("text"));
                }
            }
        }
        // String literals may be broken over lines or escaped.
        let source: String =
            source.replace("\\\"", "\"").split_whitespace().collect::<Vec<_>>().join(" ").replace("\\ ", "");
        let mut unsaid = Vec::new();
        for (english, _) in SENTENCES {
            let longest = english.split("{}").max_by_key(|piece| piece.len()).unwrap_or_default();
            if !source.contains(longest.trim_matches([' ', ':', ';', '.'])) {
                unsaid.push(longest);
            }
        }
        assert!(unsaid.is_empty(), "nobody says {unsaid:#?}");
    }
}
