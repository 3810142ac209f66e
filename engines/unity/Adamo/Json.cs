using System;
using System.Collections;
using System.Collections.Generic;
using System.Globalization;
using System.Text;

namespace Adamo
{
    /// <summary>What went wrong, in a sentence that ADAMO shows.</summary>
    public sealed class AdamoException : Exception
    {
        public AdamoException(string message) : base(message) { }
    }

    /// <summary>A small JSON reader and writer: Unity has none for open-ended messages.</summary>
    /// <remarks>Objects are dictionaries, arrays are lists, all numbers are doubles.</remarks>
    public static class Json
    {
        const int Deepest = 64;

        public static object Parse(string text)
        {
            var reader = new Reader(text);
            object value = reader.Value(0);
            reader.End();
            return value;
        }

        public static string Text(object value)
        {
            var text = new StringBuilder();
            Put(text, value);
            return text.ToString();
        }

        public static Dictionary<string, object> Map(object value) { return As<Dictionary<string, object>>(value, "an object"); }
        public static string Words(object value) { return As<string>(value, "a text"); }
        public static bool Truth(object value) { return As<bool>(value, "true or false"); }
        public static double Number(object value) { return As<double>(value, "a number"); }

        public static int Whole(object value)
        {
            double number = Number(value);
            if (number != Math.Floor(number) || Math.Abs(number) > int.MaxValue)
                throw new AdamoException(number + " is no whole number.");
            return (int)number;
        }

        public static List<T> List<T>(object value, Func<object, T> read)
        {
            return As<List<object>>(value, "a list").ConvertAll(item => read(item));
        }

        public static Dictionary<string, T> Table<T>(object value, Func<object, T> read)
        {
            var table = new Dictionary<string, T>();
            foreach (var pair in Map(value)) table[pair.Key] = read(pair.Value);
            return table;
        }

        public static object Each<T>(List<T> items, Func<T, object> write)
        {
            return items.ConvertAll(item => write(item));
        }

        public static object Entries<T>(Dictionary<string, T> table, Func<T, object> write)
        {
            var map = new Dictionary<string, object>();
            foreach (var pair in table) map[pair.Key] = write(pair.Value);
            return map;
        }

        static T As<T>(object value, string what)
        {
            if (value is T) return (T)value;
            throw new AdamoException("something else came where " + what + " belongs.");
        }

        static void Put(StringBuilder text, object value)
        {
            if (value == null) text.Append("null");
            else if (value is bool) text.Append((bool)value ? "true" : "false");
            else if (value is string) Quote(text, (string)value);
            else if (value is IDictionary) PutMap(text, (IDictionary)value);
            else if (value is IEnumerable) PutList(text, (IEnumerable)value);
            else PutNumber(text, Convert.ToDouble(value, CultureInfo.InvariantCulture));
        }

        static void PutNumber(StringBuilder text, double number)
        {
            if (double.IsNaN(number) || double.IsInfinity(number))
                throw new AdamoException("a number is not finite.");
            text.Append(number.ToString("R", CultureInfo.InvariantCulture));
        }

        static void PutMap(StringBuilder text, IDictionary map)
        {
            string between = "{";
            foreach (DictionaryEntry pair in map)
            {
                text.Append(between);
                Quote(text, (string)pair.Key);
                text.Append(':');
                Put(text, pair.Value);
                between = ",";
            }
            text.Append(between == "{" ? "{}" : "}");
        }

        static void PutList(StringBuilder text, IEnumerable items)
        {
            string between = "[";
            foreach (object item in items)
            {
                text.Append(between);
                Put(text, item);
                between = ",";
            }
            text.Append(between == "[" ? "[]" : "]");
        }

        static void Quote(StringBuilder text, string words)
        {
            text.Append('"');
            foreach (char c in words)
            {
                if (c == '"' || c == '\\') text.Append('\\').Append(c);
                else if (c < ' ') text.Append("\\u").Append(((int)c).ToString("x4"));
                else text.Append(c);
            }
            text.Append('"');
        }

        sealed class Reader
        {
            readonly string text;
            int at;

            public Reader(string text) { this.text = text; }

            public void End()
            {
                if (Peek() != '\0') throw Wrong("the end");
            }

            public object Value(int depth)
            {
                if (depth > Deepest) throw new AdamoException("the message is nested too deep.");
                switch (Peek())
                {
                    case '{': return Map(depth);
                    case '[': return List(depth);
                    case '"': return Words();
                    case 't': return Word("true", true);
                    case 'f': return Word("false", false);
                    case 'n': return Word("null", null);
                    default: return Number();
                }
            }

            char Peek()
            {
                while (at < text.Length && " \t\r\n".IndexOf(text[at]) >= 0) at++;
                return at < text.Length ? text[at] : '\0';
            }

            void Take(char wanted)
            {
                if (Peek() != wanted) throw Wrong("'" + wanted + "'");
                at++;
            }

            AdamoException Wrong(string wanted)
            {
                return new AdamoException("the message is no JSON: " + wanted + " is missing at " + at + ".");
            }

            object Word(string word, object value)
            {
                if (string.CompareOrdinal(text, at, word, 0, word.Length) != 0) throw Wrong(word);
                at += word.Length;
                return value;
            }

            object Map(int depth)
            {
                var map = new Dictionary<string, object>();
                Take('{');
                if (Peek() == '}') { at++; return map; }
                while (true)
                {
                    Peek();
                    string key = Words();
                    Take(':');
                    map[key] = Value(depth + 1);
                    if (Peek() == '}') { at++; return map; }
                    Take(',');
                }
            }

            object List(int depth)
            {
                var items = new List<object>();
                Take('[');
                if (Peek() == ']') { at++; return items; }
                while (true)
                {
                    items.Add(Value(depth + 1));
                    if (Peek() == ']') { at++; return items; }
                    Take(',');
                }
            }

            string Words()
            {
                var words = new StringBuilder();
                Take('"');
                while (at < text.Length && text[at] != '"')
                {
                    char c = text[at++];
                    words.Append(c == '\\' ? Escaped() : c);
                }
                Take('"');
                return words.ToString();
            }

            char Escaped()
            {
                const string names = "\"\\/bfnrt", meanings = "\"\\/\b\f\n\r\t";
                if (at >= text.Length) throw Wrong("a letter");
                char c = text[at++];
                if (c != 'u')
                {
                    int number = names.IndexOf(c);
                    if (number < 0) throw Wrong("a letter");
                    return meanings[number];
                }
                int code;
                string digits = at + 4 <= text.Length ? text.Substring(at, 4) : "";
                if (!int.TryParse(digits, NumberStyles.AllowHexSpecifier, CultureInfo.InvariantCulture, out code))
                    throw Wrong("four digits");
                at += 4;
                return (char)code;
            }

            object Number()
            {
                int start = at;
                while (at < text.Length && "+-.eE0123456789".IndexOf(text[at]) >= 0) at++;
                double number;
                if (!double.TryParse(text.Substring(start, at - start), NumberStyles.Float, CultureInfo.InvariantCulture, out number))
                    throw Wrong("a number");
                return number;
            }
        }
    }
}
